#!/usr/bin/env python3
"""Prints the constants of flip_test.cpp, computed by the authors' package: pip install flip-evaluator==1.7 numpy."""
import flip_evaluator
import numpy as np

x, y, c = np.meshgrid(np.arange(96), np.arange(64), np.arange(3), indexing="xy")
truth = ((x // 8 + y // 8) % 2 * (3 - c) * 16 + (c + 1) * x // 2 + y) % 128
noisy = np.clip(truth + (37 * x + 91 * y + 53 * c) % 29 - 14, 0, 127)
shifted = np.roll(truth, -1, axis=1)
shifted[:, -1] = truth[:, -1]


def encoded(v):
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055).astype(np.float32)


def flip(image, reference, **parameters):
    return flip_evaluator.evaluate(encoded(reference), encoded(image), "LDR", parameters=parameters)[1]


def on_screen(v, reference):
    v = v * 0.245 / np.median(reference)
    return np.minimum(1, 1.25 * v / (1 + v))


print("noisy", flip(noisy / 128, truth / 128))
print("shifted", flip(shifted / 128, truth / 128))
print("cast", flip(truth / 128 * [1, 0.75, 0.5], truth / 128))
print("noisy, 25 pixels per degree", flip(noisy / 128, truth / 128, ppd=25.0))
print("noisy, 150 pixels per degree", flip(noisy / 128, truth / 128, ppd=150.0))
radiance, reference = 8 * (noisy / 128) ** 2, 8 * (truth / 128) ** 2
print("radiance", flip(on_screen(radiance, reference), on_screen(reference, reference)))
