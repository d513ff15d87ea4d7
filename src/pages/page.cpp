#include "pages/page.h"

#include "image/atomic_file.h"
#include "pages/assets.h"
#include "pages/html_text.h"
#include "pages/sections.h"

namespace lumirank::pages {

void write_comparison_page(const std::string& folder, const Comparison& results) {
  const ComparisonSummary summary = summarize(results);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
      escape_html(results.scene) + " – comparison of methods</title>\n<style>" + kCompareStyle +
      "</style></head>\n<body><main>\n";
  page += header_section(results, summary);
  page += error_section(results, summary);
  page += image_section(results, summary);
  page += table_section(summary);
  page += phase_section(summary);
  page += singular_value_section(results);
  page += "<footer>Lumirank " + escape_html(results.version) +
          " · the same numbers as data: <a href=\"results.json\">results.json</a>, <a "
          "href=\"results.csv\">results.csv</a></footer>\n</main><div id=\"tip\" "
          "role=\"status\"></div>\n<script>" +
          kCompareScript + "</script></body></html>\n";
  image::write_whole_file(folder + "/index.html", page);
}

}  // namespace lumirank::pages
