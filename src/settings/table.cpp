#include "settings/table.h"

#include "methods/method.h"

namespace lumirank::settings {
namespace {

Row method_row() {
  Field field{"method", "choice", "auto", "auto", "", "how the row sums of the matrix are estimated"};
  for (const auto& m : methods::all_methods()) field.range += "|" + m.name;
  return {field,
          [](RenderSettings& s, const std::string& text) {
            // That of shots is refused where one picture is made. Throws with the list.
            if (text != "auto" && text != methods::kMethodOfShots) methods::find_method(text);
            s.method.name = text;
          },
          [](const RenderSettings& s) { return s.method.name; }};
}

// What it is where it is not given depends on where the lights stand.
Row light_roughness_row() {
  return {{"light-roughness", "text", "auto", "auto, or 0 … 1", "",
           "point lights: lobes of their surfaces that are less rough than this shine as if they were so "
           "rough, so that caustics are blurred instead of spotted; 0: as they are; auto: 0.1, on gather "
           "samples 0.3"},
          [](RenderSettings& s, const std::string& text) {
            s.lights.roughness.reset();
            if (text == "auto") return;
            const double value = parse_number<double>("light-roughness", text);
            if (value < 0 || value > 1)
              throw InputError("'light-roughness' is " + text + "; it must be auto or lie in 0 … 1");
            s.lights.roughness = value;
          },
          [](const RenderSettings& s) {
            return s.lights.roughness ? format_number(*s.lights.roughness) : std::string("auto");
          }};
}

}  // namespace

void add_light_rows(std::vector<Row>& t) {
  using S = RenderSettings;
  t.push_back(number(
      {"lights", "", "100000", "1 … 50000000", "lights",
       "virtual lights to generate, all kinds together; costs memory (about 400 B each) and time in rows"},
      At<&S::lights, &VirtualLightSettings::count>{}, 1, 5e7));
  t.push_back(choice({"light-type", "", "point", "", "", "kind of indirect virtual light"},
                     At<&S::lights, &VirtualLightSettings::type>{}));
  t.push_back(
      choice({"light-placement", "", "auto", "", "",
              "where indirect virtual lights stand: where particles land, or on gather samples tied to "
              "the surfaces, the same lights in every frame; auto: gather for tensor clustering"},
             At<&S::lights, &VirtualLightSettings::placement>{}));
  t.push_back(light_roughness_row());
  t.push_back(number({"radius-scale", "", "0", "0 … 1000", "",
                      "spherical lights: radius over the distance to the 10th nearest light; 0: by the "
                      "number of lights"},
                     At<&S::lights, &VirtualLightSettings::radius_scale>{}, 0, 1000));
  t.push_back(
      choice({"sphere-indicator", "", "disc", "", "",
              "spherical lights: what is taken for the lit surface close by; cosine: as in the paper"},
             At<&S::lights, &VirtualLightSettings::sphere_indicator>{}));
  t.push_back(choice({"sphere-strategies", "", "all", "", "",
                      "spherical lights: sample cone and both BSDFs, or the cone alone"},
                     At<&S::lights, &VirtualLightSettings::sphere_strategies>{}));
  t.push_back(
      choice({"sphere-samples", "", "overlap", "", "",
              "spherical lights: samples by the overlap of lobes and cone, or by the cone alone as in "
              "the paper"},
             At<&S::lights, &VirtualLightSettings::sphere_samples>{}));
}

void add_run_rows(std::vector<Row>& t) {
  using S = RenderSettings;
  t.push_back(number({"seed", "", "1", "0 … 2^63", "", "fixes every random choice"}, Top<&S::seed>{}, 0,
                     9223372036854775808.0));
  t.push_back(number({"method-seed", "", "0", "0 … 2^63", "",
                      "other random choices of the method on the same lights and receivers; 0: as --seed"},
                     At<&S::method, &MethodSettings::seed>{}, 0, 9223372036854775808.0));
  t.push_back(number({"threads", "", "0", "0 … 1024", "threads", "0: all; the image does not depend on it"},
                     Top<&S::threads>{}, 0, 1024));
  t.push_back(number(
      {"time", "", "0", "0 … 1e7", "s", "time budget for seconds.total, divided among the stages; 0: none"},
      Top<&S::time>{}, 0, 1e7));
  t.push_back(
      number({"passes", "", "0", "0 … 65536", "pictures",
              "with receivers and lights of their own, of which the mean is shown; 0: as many as "
              "--time or --error allow (without either --spp, or 16) where the method is made for it"},
             Top<&S::passes>{}, 0, 65536));
  t.push_back(choice({"denoise", "", "auto", "", "",
                      "take the noise out of a picture of passes, by Open Image Denoise where it is found"},
                     Top<&S::denoise>{}));
  t.push_back(number(
      {"error", "", "0", "0 … 10", "", "stop when the estimated error is below; 0: the method's default"},
      At<&S::method, &MethodSettings::target_error>{}, 0, 10));
  t.push_back(choice({"error-metric", "", "l1", "", "",
                      "what --error is of: relative L1, or in pictures of passes or paths relMSE or FLIP"},
                     At<&S::method, &MethodSettings::error_metric>{}));
}

void add_traced_rows(std::vector<Row>& t) {
  using S = RenderSettings;
  t.push_back(choice({"direct", "", "auto", "", "",
                      "direct light at receivers: by columns, traced with multiple importance sampling, or "
                      "traced in sharp lobes (roughness below 0.15) and by columns in the others"},
                     At<&S::traced, &TracedLightSettings::direct>{}));
  t.push_back(number({"local-paths", "", "0", "0 … 1048576", "paths per receiver",
                      "trace the light that virtual lights blur, in sharp lobes and from close by, "
                      "instead of gathering it from columns (unbiased, noisy); 0: do not"},
                     At<&S::traced, &TracedLightSettings::local_paths>{}, 0, 1 << 20));
  t.push_back(number({"local-sharp", "", "0.3", "0 … 1", "roughness",
                      "with local-paths: lobes sharper than this are traced"},
                     At<&S::traced, &TracedLightSettings::local_sharp>{}, 0, 1));
  t.push_back(number({"local-near", "", "4", "0 … 1000", "radii",
                      "with local-paths, of spherical lights: places nearer than this are traced"},
                     At<&S::traced, &TracedLightSettings::local_near>{}, 0, 1000));
  t.push_back(
      choice({"rest", "", "auto", "", "",
              "paths that columns cannot carry: leave out, add by path tracing (noisy), or add "
              "where a pilot finds that they bring more than 0.5 % of the light, or shapes that are seen"},
             At<&S::traced, &TracedLightSettings::rest>{}));
  t.push_back(choice(
      {"panes", "", "straight", "", "",
       "thin sheets of smooth glass, flat or bent: let light go straight on, also towards what it lights, "
       "or bend it"},
      At<&S::traced, &TracedLightSettings::panes>{}));
  t.push_back(number({"compensate", "", "0", "0 … 1048576", "paths per pixel",
                      "give back what clamping took from indirect light by path tracing (unbiased, "
                      "noisy); 0: do not"},
                     At<&S::traced, &TracedLightSettings::compensate>{}, 0, 1 << 20));
}

const std::vector<Row>& table() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> t;
    t.push_back(method_row());
    add_light_rows(t);
    add_view_rows(t);
    add_run_rows(t);
    add_traced_rows(t);
    add_output_rows(t);
    return t;
  }();
  return rows;
}

}  // namespace lumirank::settings
