#include "scenedesc/mitsuba/bsdf_fields.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

using Builder = BsdfKind (*)(Reader&, Plugin&);
const std::map<std::string, Builder>& builders() {
  static const std::map<std::string, Builder> all = {
      {"diffuse", diffuse},
      {"roughdiffuse", rough_diffuse},
      {"dielectric", plain_bsdf<DielectricDesc>},
      {"roughdielectric", plain_bsdf<DielectricDesc>},
      {"thindielectric", plain_bsdf<ThinDielectricDesc>},
      {"conductor", conductor},
      {"roughconductor", conductor},
      {"plastic", plastic},
      {"roughplastic", plastic},
      {"pplastic", polarized_plastic},
      {"phong", plain_bsdf<PhongDesc>},
      {"ward", ward},
      {"principled", principled},
      {"principledthin", principled_thin},
      {"difftrans", plain_bsdf<DiffuseTransmitterDesc>},
      {"merl", plain_bsdf<MeasuredDesc>},
      {"measured", plain_bsdf<MeasuredDesc>},
      {"hair", hair},
      {"kajiyakay", plain_bsdf<HairDesc>},  // only Lumirank has it
      {"coating", coating},
      {"roughcoating", coating},
      {"mask", plain_bsdf<MaskDesc>},
      {"twosided", two_sided},
      {"bumpmap", bump_map},
      {"bump", bump_map},
      {"normalmap", normal_map},
      {"mixturebsdf", mixture},
      {"blendbsdf", blend},
      {"null", plain_bsdf<NullBsdfDesc>},
  };
  return all;
}

}  // namespace

int Reader::build_bsdf(const Element& element) {
  if (const auto found = bsdfs_.find(&element); found != bsdfs_.end()) return found->second;
  const OpenGuard guard(*this, element);
  Plugin p(*this, element);
  int index = kNone;
  if (const auto builder = builders().find(p.type()); builder != builders().end()) {
    // A two-step push: nested BSDFs come before the ones that use them.
    BsdfKind kind = builder->second(*this, p);
    p.finish();
    index = add_bsdf(p.id(), p.where(), std::move(kind));
  } else {
    const auto nested = p.take_all("bsdf");
    if (nested.size() == 1) {
      warn(p.where(), "the BSDF \"" + p.type() + "\"", "the BSDF in it");
      index = build_bsdf(*nested[0]);
    } else {
      warn(p.where(), "the BSDF \"" + p.type() + "\"", "diffuse, gray 0.5");
      index = add_bsdf(p.id(), p.where(), DiffuseDesc{});
    }
  }
  bsdfs_[&element] = index;
  return index;
}

}  // namespace lumirank::scenedesc::mitsuba
