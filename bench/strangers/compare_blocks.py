"""What the scripts that go through a format feature by feature say of two pictures of the same scene."""
import numpy as np
import OpenEXR


def load(file):
    channels = OpenEXR.File(str(file)).channels()
    return np.array((channels["RGB"] if "RGB" in channels else channels["RGBA"]).pixels, dtype=np.float64)[..., :3]


def blocks(picture):
    h, w = picture.shape[0] // 8, picture.shape[1] // 8
    return picture[:8 * h, :8 * w].mean(2).reshape(h, 8, w, 8).mean((1, 3))


def line(name, ours, theirs, messages, max_block=0.06, max_mean=0.012):
    """The ratio of the means of the channels; the least and greatest difference of blocks of 8×8 pixels, relative to theirs; <<< where these are beyond the limits."""
    mean = ours.mean((0, 1)) / theirs.mean((0, 1))
    off = (blocks(ours) - blocks(theirs)) / (blocks(theirs) + 0.05 * theirs.mean())
    mark = "   <<<" if np.abs(off).max() > max_block or np.abs(mean - 1).max() > max_mean else ""
    return f"{name:26s} {' '.join(f'{m:.3f}' for m in mean)}   {off.min():+.3f} {off.max():+.3f} {messages}{mark}"
