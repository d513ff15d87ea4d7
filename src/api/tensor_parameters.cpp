#include "api/tensor_parameters.h"

#include <functional>

#include "lumirank/animate.h"
#include "methods/parameters.h"

namespace lumirank {
namespace {

using methods::Field;
using methods::FieldText;

struct Row {
  Field<TensorSettings> field;
  std::function<std::string(const TensorSettings&)> text;
};

Row whole(FieldText text, int TensorSettings::*member, int least, int most) {
  return {{{text.key, "integer", std::to_string(TensorSettings{}.*member),
            std::to_string(least) + " … " + std::to_string(most), text.unit, text.help},
           [=](TensorSettings& t, const std::string& value) {
             std::size_t count = 0;
             if (!methods::parse_count(value, static_cast<std::size_t>(least), static_cast<std::size_t>(most),
                                       count))
               return false;
             t.*member = static_cast<int>(count);
             return true;
           }},
          [=](const TensorSettings& t) { return std::to_string(t.*member); }};
}

Row number(FieldText text, double TensorSettings::*member) {
  return {methods::number_field<TensorSettings>(std::move(text), member, 0, 1e9),
          [=](const TensorSettings& t) { return methods::number_text(t.*member); }};
}

// `names`: of the values from 0 on.
template <typename E>
Row choice(const FieldText& text, E TensorSettings::*member, const std::vector<std::string>& names) {
  return {methods::choice_field<TensorSettings>(text, member, names),
          [=](const TensorSettings& t) { return names[static_cast<std::size_t>(t.*member)]; }};
}

Row experiment(Row row) {
  row.field.info.experiment = true;
  return row;
}

const std::vector<Row>& rows() {
  using T = TensorSettings;
  static const std::vector<Row> all = {
      whole({"rows", "receivers", "receivers of each frame whose entries for all lights are read"}, &T::rows,
            1, 10'000),
      whole({"columns", "", "clusters for each frame in the mean; 0: all columns, the sum they approach"},
            &T::columns, 0, 1'000'000),
      whole({"chunk", "frames", "made together, counted from the first one of the motion"}, &T::chunk, 1,
            1000),
      whole({"overlap", "frames", "that a chunk goes on for, blended into the first ones of the next"},
            &T::overlap, 0, 1000),
      number({"memory", "MB", "of the process, about: chunks are made shorter for it; 0: any"}, &T::memory),
      choice({"carry", "",
              "whether columns are carried to the cluster's other frames; auto: where it saves much"},
             &T::carrying, {"auto", "on", "off"}),
      number({"max-change", "",
              "part of its light by which a place may differ from what is carried there; 0: any"},
             &T::max_change),
      number({"max-distance", "samples", "from what another frame shows, as far as light is carried; 0: any"},
             &T::max_distance),
      number({"max-peak", "",
              "of the mean light: clusters whose light peaks more are summed light by light; 0: none"},
             &T::max_peak),
      whole({"filter", "passes", "that average light with a frame on either side where it changes evenly"},
            &T::filter, 0, 100),
      choice({"clusters", "", "on: each chunk's clusters are written as clusters_0000.json"},
             &T::write_clusters, {"off", "on"}),
      experiment(whole({"initial-clusters", "", "of lights, before any is split; at most a quarter of all"},
                       &T::initial_clusters, 1, 1'000'000)),
      experiment(
          number({"time-weight", "", "of what a split in time leaves against one in lights; 0: none in time"},
                 &T::time_weight)),
      experiment(
          choice({"representatives", "", "the light nearest to the cluster's mean, or of the largest norm"},
                 &T::largest_representatives, {"central", "largest"})),
      experiment(whole({"bits", "", "16 or 32: of the entries of the rows in memory"}, &T::bits, 16, 32)),
  };
  return all;
}

}  // namespace

TensorSettings tensor_settings(const std::map<std::string, std::string>& parameters) {
  methods::Fields<TensorSettings> fields;
  for (const Row& row : rows()) fields.push_back(row.field);
  return methods::read_settings(api::kTensorClustering, fields, parameters);
}

std::map<std::string, std::string> parameters_of(const TensorSettings& settings) {
  std::map<std::string, std::string> out;
  for (const Row& row : rows()) out[row.field.info.key] = row.text(settings);
  return out;
}

namespace api {

MethodDescription describe_tensor_clustering() {
  MethodDescription out{
      kTensorClustering,
      "Frames of a shot together: clusters of lights over all of them, one column each; only "
      "with `lumirank animate`.",
      "Hašan et al. 2008, Tensor Clustering for Rendering Many-Light Animations",
      {},
      true};
  for (const Row& row : rows()) {
    const methods::Parameter& p = row.field.info;
    out.parameters.push_back({p.key, p.type, p.default_text, p.range, p.unit, p.help, p.experiment});
  }
  return out;
}

}  // namespace api
}  // namespace lumirank
