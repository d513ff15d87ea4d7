#include "lumirank/settings.h"

#include <gtest/gtest.h>

#include "lumirank/error.h"

namespace lumirank {
namespace {

TEST(Settings, EveryFieldHasItsStatedDefault) {
  const RenderSettings settings;
  for (const Field& field : render_fields())
    EXPECT_EQ(get_field(settings, field.key), field.default_text) << field.key;
}

TEST(Settings, RoundTripThroughJson) {
  RenderSettings settings;
  set_field(settings, "size", "800x600");
  set_field(settings, "crop", "1,2,30,40");
  set_field(settings, "clamp", "0.1");
  set_field(settings, "method", "row-column-sampling");
  set_field(settings, "aov", "direct,light:lamp one");
  set_field(settings, "seed", "18446744073709551");
  settings.method.parameters["rows"] = "300";
  const std::string json = to_json(settings);
  const RenderSettings back = render_settings_from_json(json);
  EXPECT_EQ(to_json(back), json);
  EXPECT_EQ(back.view.width, 800);
  EXPECT_EQ(back.view.crop[3], 40);
  EXPECT_EQ(back.lights.clamp, 0.1);
  EXPECT_EQ(back.layers.at(1), "light:lamp one");
  EXPECT_EQ(back.method.parameters.at("rows"), "300");
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Settings, UnknownKeyListsTheValidOnes) {
  const std::string message = message_of([] { render_settings_from_json(R"({"lihgts": 5})"); });
  EXPECT_NE(message.find("lihgts"), std::string::npos);
  EXPECT_NE(message.find("lights"), std::string::npos);
  EXPECT_NE(message.find("max-depth"), std::string::npos);
}

TEST(Settings, UnknownMethodListsTheValidOnes) {
  RenderSettings settings;
  const std::string message = message_of([&] { set_field(settings, "method", "magic"); });
  EXPECT_NE(message.find("row-column-sampling"), std::string::npos) << message;
}

TEST(Settings, WrongValuesAreErrors) {
  const std::pair<const char*, const char*> wrong[] = {
      {"lights", "0"},   {"lights", "-5"},    {"lights", "many"},  {"lights", "1e5"},
      {"size", "800"},   {"size", "0x600"},   {"size", "-8x6"},    {"size", "99999x10"},
      {"spp", "0"},      {"clamp", "-1"},     {"clamp", "nan"},    {"only", "both"},
      {"threads", "-1"}, {"time", "inf"},     {"crop", "1,2,3"},   {"crop", "0,0,0,5"},
      {"aov", "beauty"}, {"max-depth", "-2"}, {"direct", "maybe"}, {"backend", "abacus"}};
  for (const auto& [key, value] : wrong) {
    RenderSettings settings;
    EXPECT_NE(message_of([&, key = key, value = value] { set_field(settings, key, value); }), "no error")
        << key << "=" << value;
  }
}

TEST(Settings, ReportGivesItsSettingsBack) {
  RenderSettings settings;
  set_field(settings, "lights", "1234");
  const RenderSettings back =
      render_settings_from_report(R"({"method":"x","parameters":)" + to_json(settings) + "}");
  EXPECT_EQ(back.lights.count, 1234u);
  EXPECT_NE(message_of([] { render_settings_from_report("[1,2]"); }), "no error");
}

}  // namespace
}  // namespace lumirank
