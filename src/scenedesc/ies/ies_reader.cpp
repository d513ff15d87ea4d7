#include <algorithm>
#include <cctype>
#include <filesystem>

#include "scenedesc/ies/ies.h"
#include "scenedesc/ies/number_stream.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc {
namespace {

constexpr int kMaxAngles = 100000;
constexpr float kMinStep = 1e-3f;  // degrees
constexpr float kMetersPerFoot = 0.3048f;

struct TextLine {
  std::string_view text;
  std::size_t next;  // where the following line begins
};

TextLine line_at(std::string_view text, std::size_t begin) {
  const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
  std::size_t next = std::min(end + 1, text.size());
  if (end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n') ++next;
  return {text.substr(begin, end - begin), next};
}

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
  return s;
}

std::string upper(std::string_view s) {
  std::string out(s);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

bool ends_with(const std::string& s, const std::string& end) {
  return s.size() >= end.size() && s.compare(s.size() - end.size(), end.size(), end) == 0;
}

// The edition from the first line; files of 1986 have none.
int edition(std::string_view first, const std::string& filename, IesData& out) {
  const std::string line = upper(trimmed(first));
  if (line.rfind("IES", 0) != 0) return 1986;
  const std::pair<const char*, int> known[] = {{"86", 1986},   {"91", 1991},  {"1995", 1995}, {"95", 1995},
                                               {"2002", 2002}, {"-02", 2002}, {"2019", 2019}, {"-19", 2019}};
  for (const auto& [end, year] : known)
    if (ends_with(line, end)) return year;
  out.warn({filename, 1}, "an edition of IES LM-63 other than 1986 to 2019", "that of 2002");
  return 2002;
}

std::vector<float> numbers(NumberStream& in, std::size_t count, const std::string& what) {
  // A count that lies must not allocate: every number takes two characters with its separator.
  if (count > in.left() / 2 + 1)
    in.fail(std::to_string(count) + " " + what + "s are announced, more than the file has room for");
  std::vector<float> out(count);
  for (std::size_t k = 0; k < count; ++k)
    out[k] = in.number(what + " " + std::to_string(k + 1) + " of " + std::to_string(count));
  return out;
}

std::vector<float> ascending_angles(NumberStream& in, int count, const std::string& what, float min_value,
                                    float max_value) {
  auto out = numbers(in, static_cast<std::size_t>(count), what);
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!(out[k] >= min_value && out[k] <= max_value))
      in.fail(what + " " + std::to_string(k + 1) + " is not between " +
              std::to_string(static_cast<int>(min_value)) + " and " +
              std::to_string(static_cast<int>(max_value)) + " degrees");
    if (k > 0 && !(out[k] - out[k - 1] > kMinStep))
      in.fail(what + " " + std::to_string(k + 1) + " is not above the one before it");
  }
  return out;
}

void read_tilt(NumberStream& in, IesData& out) {
  in.count("the lamp-to-luminaire geometry", 1, 3);
  const int pairs = in.count("the number of tilt angles", 1, kMaxAngles);
  out.tilt_angles = ascending_angles(in, pairs, "tilt angle", -180, 180);
  out.tilt_factors = numbers(in, out.tilt_angles.size(), "tilt factor");
  for (const float factor : out.tilt_factors)
    if (!(factor >= 0)) in.fail("a tilt factor is negative");
}

// The ten numbers and the three, the angles and the table.
void read_photometry(NumberStream& in, IesData& out) {
  out.lamps = in.count("the number of lamps", 1, kMaxAngles);
  out.lumens_per_lamp = in.number("lumens per lamp");
  const float multiplier = in.positive("the candela multiplier");
  const int verticals = in.count("the number of vertical angles", 2, kMaxAngles);
  const int horizontals = in.count("the number of horizontal angles", 1, kMaxAngles);
  out.type = static_cast<IesData::Type>(in.count("the photometric type", 1, 3));
  const float unit = in.count("the type of units", 1, 2) == 1 ? kMetersPerFoot : 1.0f;
  for (int k = 0; k < 3; ++k) out.opening[k] = unit * in.number("the size of the luminous opening");
  const float ballast = in.positive("the ballast factor");
  // Up to 1991 a factor; later editions reserve the place or keep a code there.
  const float photometric = in.number("the ballast-lamp photometric factor");
  if (out.year < 1995 && !(photometric > 0)) in.fail("the ballast-lamp photometric factor is not above 0");
  in.number("the input power");

  const bool polar = out.type == IesData::Type::C;
  out.vertical =
      ascending_angles(in, verticals, "vertical angle", polar ? 0.0f : -90.0f, polar ? 180.0f : 90.0f);
  out.horizontal =
      ascending_angles(in, horizontals, "horizontal angle", polar ? 0.0f : -90.0f, polar ? 360.0f : 90.0f);
  out.candela = numbers(in, out.vertical.size() * out.horizontal.size(), "candela value");
  const float factor = multiplier * ballast * (out.year < 1995 ? photometric : 1.0f);
  for (std::size_t k = 0; k < out.candela.size(); ++k) {
    const bool negative = out.candela[k] < 0;
    out.candela[k] *= factor;
    if (negative || !std::isfinite(out.candela[k]))
      in.fail("candela value " + std::to_string(k + 1) +
              (negative ? " is negative" : " times its factors is not finite"));
  }
  if (in.at_number())
    in.fail("there are more candela values than the " + std::to_string(out.candela.size()) +
            " of the numbers of angles");
  if (!in.at_end()) {
    out.warn(in.where(), "text after the candela values", "");
    out.warnings.back().harmless = true;
  }
}

}  // namespace

IesData parse_ies(const std::string& text, const std::string& filename) {
  IesData out;
  std::string_view rest = text;
  if (rest.substr(0, 3) == "\xef\xbb\xbf") rest.remove_prefix(3);
  out.year = edition(line_at(rest, 0).text, filename, out);
  int number = 1;
  for (std::size_t at = 0; at < rest.size(); ++number) {
    const TextLine line = line_at(rest, at);
    at = line.next;
    const std::string_view stated = trimmed(line.text);
    if (upper(stated.substr(0, 5)) != "TILT=") continue;
    const std::string_view tilt = trimmed(stated.substr(5));
    NumberStream in(rest.substr(at), filename, number + 1);
    if (upper(tilt) == "INCLUDE") {
      read_tilt(in, out);
    } else if (tilt.empty()) {
      throw InputError({filename, number}, "TILT= says nothing", "write TILT=NONE");
    } else if (upper(tilt) != "NONE") {
      out.tilt_file = tilt;
    }
    read_photometry(in, out);
    return out;
  }
  throw InputError({filename, number},
                   "this is no IES photometric file: it has no line that begins with TILT=",
                   "give a file in the format IES LM-63");
}

void parse_tilt(const std::string& text, const std::string& filename, IesData& out) {
  NumberStream in(text, filename, 1);
  read_tilt(in, out);
  out.tilt_file.clear();
}

IesData read_ies(const std::string& filename) {
  IesData out = parse_ies(read_file(filename, {filename, 0}), filename);
  if (!out.tilt_file.empty()) {
    const auto file = std::filesystem::path(filename).parent_path() / out.tilt_file;
    parse_tilt(read_file(file.string(), {file.string(), 0}), file.string(), out);
  }
  return out;
}

float IesData::tilt_factor(float degrees) const {
  if (tilt_angles.empty()) return 1;
  const auto above = std::upper_bound(tilt_angles.begin(), tilt_angles.end(), degrees);
  if (above == tilt_angles.begin()) return tilt_factors.front();
  if (above == tilt_angles.end()) return tilt_factors.back();
  const auto k = static_cast<std::size_t>(above - tilt_angles.begin());
  const float t = (degrees - tilt_angles[k - 1]) / (tilt_angles[k] - tilt_angles[k - 1]);
  return tilt_factors[k - 1] + (tilt_factors[k] - tilt_factors[k - 1]) * t;
}

}  // namespace lumirank::scenedesc
