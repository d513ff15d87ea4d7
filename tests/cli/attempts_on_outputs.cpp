// Outputs that would destroy inputs, devices or each other, or that cannot be written.
#include "attempts.h"

namespace lumirank::test {

std::vector<Attempt> attempts_on_outputs() {
  // A picture of a scene that consists of several files, as small as it can be.
  const std::string render = "render @/scene.xml --size 4x3 --spp 1 --lights 30 --method brute-force ";
  const std::string reference = "reference @/scene.xml --size 4x3 --spp 2 ";
  const std::string compare =
      "compare @/scene.xml --size 4x3 --spp 1 --lights 30 --methods brute-force --quiet ";
  std::vector<Attempt> all = {
      // What works.
      {render + "-o @/a.exr", 0, "wrote", "a.exr"},
      {render + "-o @/a.EXR", 0, "wrote", "a.EXR"},
      {render + "-o @/a.exr -o @/b.png -o @/c.pfm --report @/r.json --preview @/p.png --quiet", 0, "",
       "a.exr b.png c.pfm p.png r.json"},
      {render + "-o @/a.png --aov illuminance", 0, "a.illuminance.png", "a.illuminance.png a.png"},
      {reference + "-o @/a.exr --report @/r.json", 0, "2 paths per pixel", "a.exr r.json"},
      {"convert @/scene.xml @/a.xml", 0, "wrote", "a.xml"},
      {compare + "--reference brute-force -o @/out", 0, "", "out"},

      // Inputs.
      {render + "-o @/tex.png", 2, "is an input"},
      {render + "-o @/./dir/../tex.png", 2, "is the input"},
      {render + "-o @/a.exr --report @/scene.xml", 2, "scene.xml: this file is an input"},
      {render + "-o @/a.exr --report @/part.xml", 2, "is an input"},
      {render + "-o @/a.exr --report @/mesh.obj", 2, "is an input"},
      {render + "-o @/a.exr --report @/steel.spd", 2, "is an input"},
      {render + "-o @/a.exr --preview @/tex.png", 2, "is an input"},
      {render + "-o @/linked.png", 2, "is the input"},
      {render + "-o @/hard.png", 2, "is the input"},
      {render + "--environment @/env.exr -o @/env.exr", 2, "is an input"},
      {render + "--environment @/env.exr -o @/a.png -o @/env.exr", 2, "is an input"},
      {render + "--replay @/replay.json -o @/a.exr --report @/replay.json", 2, "is an input"},
      {reference + "-o @/tex.png", 2, "is an input"},
      {reference + "-o @/a.exr --report @/scene.xml", 2, "is an input"},
      {reference + "--environment @/env.exr -o @/env.exr", 2, "is an input"},
      {"convert @/scene.xml @/scene.xml", 2, "is an input"},
      {"convert @/scene.xml @/part.xml", 2, "is an input"},
      {"convert @/scene.xml @/linked.xml", 2, "is the input"},
      {compare + "--reference brute-force --environment @/kept/run_0.png -o @/kept", 2, "is an input"},
      {compare + "--reference @/kept/run_0.png -o @/kept", 2, "is an input"},
      {compare + "--reference @/kept/reference.png -o @/kept", 2, "is an input"},
      // The reference that an earlier comparison left is not written again.
      {compare + "--reference @/kept/reference.exr -o @/kept", 0, "",
       "kept/index.html kept/results.csv kept/results.json kept/run_0_error.png *kept/run_0.png"},

      // Each other.
      {render + "-o @/a.exr -o @/a.exr", 2, "two outputs would be written to one file"},
      {render + "-o @/a.exr -o @/dir/../a.exr", 2, "two outputs"},
      {render + "-o @/a.exr -o @/dirlink/../a.exr", 2, "two outputs"},
      {render + "-o @/old.pfm -o @/oldlink.pfm", 2, "two outputs"},
      {render + "-o @/a.pfm --report @/a.pfm", 2, "two outputs"},
      {render + "-o @/a.png --preview @/a.png", 2, "two outputs"},
      {render + "-o @/a.exr --preview @/p.png --report @/p.png", 2, "two outputs"},
      {render + "-o @/a.png -o @/a.illuminance.png --aov illuminance", 2, "two outputs"},
      {render + "-o @/a.png --preview @/a.illuminance.png --aov illuminance", 2, "two outputs"},
      {reference + "-o @/a.pfm --report @/a.pfm", 2, "two outputs"},

      // All or none: the second cannot be written when the first is whole.
      {render + "-o @/a.pfm -o @/full.pfm", 2, "full.pfm: cannot write"},
      {render + "-o @/full.pfm -o @/a.pfm", 2, "full.pfm: cannot write"},
      {render + "-o @/old.pfm --report @/full.json", 2, "full.json: cannot write"},
      {reference + "-o @/a.pfm --report @/full.json", 2, "full.json: cannot write"},

      // Folders, sockets, links, names.
      {render + "-o @/dir", 2, "extension"},
      {render + "-o @/dir.exr", 2, "a folder has this name"},
      {render + "-o @/a.exr --report @/dir", 2, "a folder has this name"},
      {render + "-o @/a.exr --preview @/dir.png", 2, "a folder has this name"},
      {render + "-o @/a.exr --report @/socket", 2, "a socket"},
      {render + "-o @/loop.exr", 2, "cannot write the file"},
      {render + "-o @/scene.xml/a.exr", 2, "does not exist"},
      {render + "-o @/none/a.exr", 2, "create the folder first"},
      {render + "-o @/a.exr --report @/none/r.json", 2, "create the folder first"},
      {render + "-o @/a.exr --preview @/none/p.png", 2, "create the folder first"},
      {render + "-o @/a.gif", 2, "use .exr, .pfm or .png"},
      {render + "-o @/a", 2, "needs an extension"},
      {render + "-o @/.exr", 2, "extension"},
      {render + "-o ''", 2, "extension"},
      {render + "-o @/a.exr --preview @/p.exr", 2, "a preview is a PNG file"},
      {render + "-o @/a.exr --preview @/p", 2, "a preview is a PNG file"},
      {render + "-o @/a.exr --preview @/full.png", 2, "a preview is rewritten"},
      {render + "-o @/" + std::string(300, 'x') + ".exr", 2, "File name too long"},
      {"convert @/scene.xml @/a.obj", 2, "ends in .xml"},
      {"convert @/scene.xml @/none/a.xml", 2, "create the folder first"},
      {"convert @/scene.xml @/full.xml", 2, "full.xml: cannot write"},
      {"convert --quiet @/embedded.pbrt @/full.xml", 2, "full.xml: cannot write"},
      {"convert --quiet @/embedded.pbrt @/dir.xml", 2, "a folder has this name"},

      // compare's folder.
      {compare + "-o @/scene.xml", 2, "is not a folder"},
      {compare + "-o @/scene.xml/out", 2, "is not a folder"},
      {compare + "-o @/blocked", 2, "results.csv: cannot write the file: a folder has this name"},
      {compare + "-o @/blocked_late", 2, "run_0.png: cannot write the file: a folder has this name"},
      {compare + "-o @/blocked_reference", 2, "reference.png: cannot write the file: a folder has this name"},

      // Interrupted replays, reports that are none.
      {render + "-o @/a.exr --replay @/none.json", 2, "none.json"},
      {render + "-o @/a.exr --replay @/dir", 2, "dir: cannot be read"},
      {render + "-o @/a.exr --replay @/scene.xml", 2, "not a report"},
      {render + "-o @/a.exr --replay @/tex.png", 2, "not a report"},
  };
  return all;
}

}  // namespace lumirank::test
