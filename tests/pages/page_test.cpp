#include "pages/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "base/error.h"
#include "image/false_color.h"
#include "image/image_io.h"
#include "image/temporary_folder.h"
#include "pages/html_text.h"
#include "pages/svg_plot.h"

namespace lumirank::pages {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// Two methods, four settings each, three seeds; names that hurt where text is not escaped.
Comparison synthetic() {
  Comparison results;
  results.scene = "room <b>\"&'</b> </script>";
  results.reference_kind = "path tracing, 1024 paths per pixel";
  results.reference_error = 0.004;
  results.reference_seconds = 61.25;
  results.reference_image = "reference image.png";
  results.width = 320, results.height = 200;
  results.version = "0.1.0";
  results.notes = {"A note with <angles> & more.", "At equal time: nothing."};
  for (const char* method : {"power-sampling", "row-column-sampling"})
    for (int k = 0; k < 4; ++k)
      for (int seed = 0; seed < 3; ++seed) {
        ComparisonRun run;
        run.method = method;
        run.series = std::string(method) + (method[0] == 'r' ? " 1:3" : "");
        const int columns = 100 << k;
        run.label = run.series + ", " + std::to_string(columns) + " columns";
        run.settings = {{"columns", std::to_string(columns)}, {"odd", "a,\"b\"\nc"}};
        if (method[0] == 'r') run.settings["rows"] = std::to_string(columns / 3);
        run.seed = (std::uint64_t{1} << 63) + static_cast<std::uint64_t>(seed);
        run.seconds = 0.1 * (1 << k) * (1 + 0.01 * seed), run.setup_seconds = 1.0 / 3;
        run.rays = 1e6 * (1 << k), run.entries = 1.3e6 * (1 << k);
        const double error = (method[0] == 'r' ? 0.04 : 0.3) / std::sqrt(1 << k) * (1 + 0.1 * (seed - 1));
        run.error = {error, 2 * error, error / 7, error * error, -error / 10, error / 3};
        run.sampling_rate = 0.001 * columns;
        run.phases = {{"rows", 0.01}, {"columns", 0.1 * k}};
        if (method[0] == 'r') run.phases["clustering"] = 0.1;
        run.image_file = "run_" + std::to_string(results.runs.size()) + ".png";
        run.error_image_file = "run_" + std::to_string(results.runs.size()) + "_error.png";
        results.runs.push_back(run);
      }
  for (int k = 0; k < 300; ++k) results.singular_values.push_back(10 * std::exp2(-0.1 * k));
  return results;
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

// The pieces from `open` to `close`, both included.
std::vector<std::string> pieces(const std::string& text, const std::string& open, const std::string& close) {
  std::vector<std::string> found;
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
    const std::size_t end = text.find(close, at);
    if (end == std::string::npos) break;
    found.push_back(text.substr(at, end + close.size() - at));
  }
  return found;
}

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows{{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
        rows.back().back() += '"', ++i;
      } else if (c == '"') {
        quoted = false;
      } else {
        rows.back().back() += c;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      rows.back().emplace_back();
    } else if (c == '\n') {
      rows.push_back({""});
    } else if (c != '\r') {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

class ComparePage : public image::TemporaryFolder {
 protected:
  std::string page_of(const Comparison& results) {
    write_comparison_page(path(""), results);
    return read_bytes(path("index.html"));
  }
};

TEST_F(ComparePage, JsonReadsBackAsWritten) {
  Comparison results = synthetic();
  results.runs[1].error.relmse = results.runs[1].error.flip = std::nan("");
  results.scene += "\xff";  // not UTF-8
  write_results_json(path(""), results);
  const auto json = nlohmann::json::parse(read_bytes(path("results.json")));
  EXPECT_EQ(json["reference"]["relative_l1"], 0.004);
  EXPECT_EQ(json["width"], 320);
  EXPECT_EQ(json["notes"].size(), 2u);
  EXPECT_EQ(json["singular_values"][7].get<double>(), results.singular_values[7]);
  ASSERT_EQ(json["runs"].size(), results.runs.size());
  for (std::size_t k = 0; k < results.runs.size(); ++k) {
    const auto& in = results.runs[k];
    const auto& out = json["runs"][k];
    EXPECT_EQ(out["label"], in.label);
    EXPECT_EQ(out["seed"].get<std::uint64_t>(), in.seed);
    EXPECT_EQ(out["setup_seconds"].get<double>(), in.setup_seconds);
    EXPECT_EQ(out["error"]["relative_l2"].get<double>(), in.error.relative_l2);
    if (k != 1) {
      EXPECT_EQ(out["error"]["flip"].get<double>(), in.error.flip);
    }
    EXPECT_EQ((out["settings"].get<std::map<std::string, std::string>>()), in.settings);
    EXPECT_EQ((out["phases"].get<std::map<std::string, double>>()), in.phases);
    EXPECT_EQ(out["error_image"], in.error_image_file);
  }
  EXPECT_TRUE(json["runs"][1]["error"]["relmse"].is_null());
  EXPECT_TRUE(json["runs"][1]["error"]["flip"].is_null());
}

TEST_F(ComparePage, CsvReadsBackAsWritten) {
  Comparison results = synthetic();
  results.runs[0].error.bias = kInf;
  results.runs[1].error.flip = std::nan("");
  write_results_csv(path(""), results);
  const auto rows = parse_csv(read_bytes(path("results.csv")));
  ASSERT_EQ(rows.size(), results.runs.size() + 1);
  const auto column = [&](const std::string& name) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(at, rows[0].end()) << name;
    return static_cast<std::size_t>(at - rows[0].begin());
  };
  for (std::size_t k = 0; k < results.runs.size(); ++k) {
    const auto& run = results.runs[k];
    const auto& row = rows[k + 1];
    ASSERT_EQ(row.size(), rows[0].size());
    EXPECT_EQ(row[column("label")], run.label);
    EXPECT_EQ(row[column("seed")], std::to_string(run.seed));
    EXPECT_EQ(std::stod(row[column("setup_seconds")]), run.setup_seconds);
    EXPECT_EQ(std::stod(row[column("relative_l1")]), run.error.relative_l1);
    if (k != 1) {
      EXPECT_EQ(std::stod(row[column("flip")]), run.error.flip);
    }
    EXPECT_EQ(row[column("setting.odd")], "a,\"b\"\nc");
    EXPECT_EQ(row[column("setting.rows")], run.settings.contains("rows") ? run.settings.at("rows") : "");
    EXPECT_EQ(std::stod(row[column("seconds.columns")]), run.phases.at("columns"));
  }
  EXPECT_EQ(rows[1][column("bias")], "");
  EXPECT_EQ(rows[2][column("flip")], "");
}

TEST_F(ComparePage, IsWellFormedAndEscapesItsText) {
  const std::string page = page_of(synthetic());
  // With its doctype, style and script (whose text is not markup) left out, the page is XML.
  std::string body = page.substr(page.find("<body>"));
  body = body.substr(0, body.rfind("<script>")) + "</body>";
  pugi::xml_document document;
  const auto parsed = document.load_string(body.c_str());
  EXPECT_TRUE(parsed) << parsed.description() << " at "
                      << body.substr(static_cast<std::size_t>(parsed.offset), 80);
  EXPECT_EQ(std::string(document.select_node("//h1").node().text().get()), synthetic().scene);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  EXPECT_EQ(page.find("<angles>"), std::string::npos);
  // The page's own script and the list of images, each closed once.
  EXPECT_EQ(count(page, "</script>"), 2);
  // Nothing is fetched from elsewhere: the only addresses are the names of XML's own languages.
  EXPECT_EQ(count(page, "http"), count(page, "xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_NE(page.find("src=\"reference%20image.png\""), std::string::npos);
}

TEST_F(ComparePage, ShowsEverySettingOnceAndEveryImage) {
  const std::string page = page_of(synthetic());
  pugi::xml_document document;
  std::string body = page.substr(page.find("<body>"));
  body = body.substr(0, body.rfind("<script>")) + "</body>";
  ASSERT_TRUE(document.load_string(body.c_str()));
  EXPECT_EQ(document.select_nodes("//table[@id='runs']/tbody/tr").size(), 8u);
  EXPECT_EQ(document.select_nodes("//select[@id='choose-left']/option").size(), 25u);
  EXPECT_EQ(document.select_nodes("//div[@class='legend']/button").size(), 2u);
  // Four measures against time and rays, and the singular values.
  EXPECT_EQ(document.select_nodes("//svg[@class='plot']").size(), 9u);
  const auto images =
      nlohmann::json::parse(document.select_node("//script[@id='images']").node().text().get());
  ASSERT_EQ(images.size(), 25u);
  EXPECT_EQ(images[0]["image"], "reference%20image.png");
  EXPECT_EQ(images[24]["error"], "run_23_error.png");
  // Mean over the seeds of 0.04 · {0.9, 1, 1.1} is 4 %; of the times 0.1 · {1, 1.01, 1.02}, 0.101 s.
  const auto row = document.select_node("//table[@id='runs']/tbody/tr[5]").node();
  EXPECT_STREQ(row.select_node("td[8]").node().text().get(), "4.00 %");
  EXPECT_STREQ(row.select_node("td[3]").node().text().get(), "0.101 s");
  EXPECT_STREQ(row.select_node("td[12]").node().text().get(), "0.0133");  // FLIP, a third of 4 %
}

// Errors at sampled pixels have no FLIP.
TEST_F(ComparePage, WithoutFlipHasNoPlotOfIt) {
  Comparison results = synthetic();
  for (ComparisonRun& run : results.runs) run.error.flip = std::nan("");
  const std::string with = page_of(synthetic()), without = page_of(results);
  EXPECT_EQ(count(with, "value=\"flip\""), 1);
  EXPECT_EQ(count(without, "value=\"flip\""), 0);
  EXPECT_EQ(count(without, "<svg class=\"plot\""), 7);
  const char* const empty = "<td data-value=\"\">–</td>";
  EXPECT_EQ(count(without, empty), count(with, empty) + 8);  // a cell of each setting
}

// σ_k = 2^(-k/10): the share of the squares beyond the first r is 2^(-r/5), at most 1e-4 from r = 5·log2(1e4)
// = 66.4 on.
TEST_F(ComparePage, SingularValuesStateTheRankForOnePercent) {
  EXPECT_NE(page_of(synthetic()).find("The first 67 hold"), std::string::npos);
  Comparison results = synthetic();
  results.singular_values.clear();
  EXPECT_EQ(page_of(results).find("Singular values"), std::string::npos);
}

TEST_F(ComparePage, WarnsOfAWeakReference) {
  Comparison results = synthetic();
  // The lowest mean error is 0.04 / √8 = 0.01414; a fifth of it is 0.00283.
  results.reference_error = 0.0028;
  EXPECT_EQ(page_of(results).find("class=\"warn\""), std::string::npos);
  results.reference_error = 0.0029;
  EXPECT_NE(page_of(results).find("of 1 of 8 settings"), std::string::npos);
}

TEST_F(ComparePage, EmptyAndBrokenResultsStillMakeAPage) {
  EXPECT_NE(page_of({}).find("<h1>"), std::string::npos);
  Comparison results = synthetic();
  results.runs.resize(1);
  results.runs[0].error = {0, kInf, std::nan(""), 0, 0, std::nan("")};
  results.runs[0].rays = 0;
  const std::string page = page_of(results);
  for (const std::string& svg : pieces(page, "<svg class=\"plot\"", "</svg>")) {
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf\""), std::string::npos);
  }
  EXPECT_NE(page.find("1 point has no place on these axes"), std::string::npos);
}

TEST_F(ComparePage, UnwritableFolder) {
  EXPECT_THROW(write_comparison_page(path("none"), synthetic()), InputError);
  EXPECT_THROW(write_results_json(path("none"), synthetic()), InputError);
  EXPECT_THROW(write_results_csv(path("none"), synthetic()), InputError);
}

TEST(SvgPlot, PlacesPointsByTheirLogarithms) {
  Plot plot;
  plot.x = {"x", true, Unit::count};
  plot.y = {"y", true, Unit::percent};
  plot.series.push_back(
      {"a", {{100, 0.1, 0.1, 0.1, "tip"}, {1, 0.001, 0.001, 0.001, ""}, {10, 0.01, 0.005, 0.02, ""}}, true});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg_plot(plot).c_str()));
  // Sorted by x, and the middle point of two decades lies halfway, in both directions.
  std::istringstream points(document.select_node("//polyline").node().attribute("points").value());
  double x[3], y[3];
  char comma;
  for (int k = 0; k < 3; ++k) points >> x[k] >> comma >> y[k];
  EXPECT_LT(x[0], x[2]);
  EXPECT_GT(y[0], y[2]);
  EXPECT_NEAR(x[1], (x[0] + x[2]) / 2, 0.02);  // two decimals are written
  EXPECT_NEAR(y[1], (y[0] + y[2]) / 2, 0.02);
  EXPECT_EQ(document.select_nodes("//polygon[@class='band']").size(), 1u);
  std::vector<std::string> ticks;
  for (const auto& node : document.select_nodes("//text[@class='tick']"))
    ticks.push_back(node.node().text().get());
  for (const char* expected : {"1", "10", "100", "0.1 %", "1 %", "10 %"})
    EXPECT_NE(std::find(ticks.begin(), ticks.end(), expected), ticks.end()) << expected;
}

TEST(HtmlText, NumbersForPeople) {
  EXPECT_EQ(show_number(0.012345), "0.0123");
  EXPECT_EQ(show_number(12.345), "12.3");
  EXPECT_EQ(show_number(1234), "1234");
  EXPECT_EQ(show_number(-1.5e-9), "-1.50e-09");
  EXPECT_EQ(show_count(999), "999");
  EXPECT_EQ(show_count(1234567), "1.23 M");
  EXPECT_EQ(show_count(999999), "1.00 M");
  EXPECT_EQ(show_percent(0.0512), "5.12 %");
  EXPECT_EQ(show_seconds(kInf), "–");
  EXPECT_EQ(escape_html("<a href=\"x\">&'\x01"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;\xef\xbf\xbd");
  EXPECT_EQ(escape_url("a b/c#%.png"), "a%20b/c%23%25.png");
}

}  // namespace
}  // namespace lumirank::pages
