// Segments of rays in media: how alike they are, and that groups of them cover every ray once.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/random.h"
#include "transport/segments/segment_graph.h"
#include "transport/segments/segment_groups.h"

namespace lumirank::transport {
namespace {

media::Medium fog(float g) {
  media::PhaseFunction phase;
  phase.lobes[0].g = Rgb(g);
  return {media::Medium::Form::extinction_and_albedo, media::Field{Rgb(1)}, media::Field{Rgb(0.5f)},
          media::Field{}, phase};
}

// `rays` parallel rays side by side along x, each of `pieces` pieces.
std::vector<Segment> bundle(int rays, int pieces) {
  std::vector<Segment> out;
  for (int r = 0; r < rays; ++r)
    for (int k = 0; k < pieces; ++k) {
      Segment s;
      s.origin = {static_cast<float>(k) / static_cast<float>(pieces), 0.01f * static_cast<float>(r), 0};
      s.direction = {1, 0, 0}, s.length = 1 / static_cast<float>(pieces), s.medium = 0;
      s.transmittance = 0.9f, s.film = {static_cast<float>(r), 0}, s.joined = k > 0;
      out.push_back(s);
    }
  return out;
}

TEST(Segments, AlikeIsNearAndOfOneDirection) {
  const std::vector<media::Medium> media{fog(0.8f)};
  const SegmentSimilarity similarity(media, 8, true);
  Segment a;
  a.direction = {1, 0, 0}, a.length = 0.1f, a.medium = 0, a.transmittance = 0.9f;
  EXPECT_NEAR(similarity(a, a), 4, 1e-5);
  const auto than = [&](auto&& change) {
    Segment b = a;
    change(b);
    return similarity(a, b);
  };
  // Equation 10: both ends a quarter of the eighth of the diagonal away.
  EXPECT_NEAR(than([](Segment& b) { b.origin.y = 0.25f; }), 3.5f, 1e-5);
  EXPECT_NEAR(than([](Segment& b) { b.transmittance = 0.4f; }), 3.5f, 1e-5);
  EXPECT_NEAR(than([](Segment& b) { b.film = {4, 0}; }), 3 + std::exp(-0.5f), 1e-5);
  EXPECT_LT(than([](Segment& b) { b.direction = {0, 1, 0}; }), 3.0f);
  // No difference of phases takes more than what they count.
  EXPECT_GE(than([](Segment& b) { b.origin.y = 100, b.direction = {-1, 0, 0}; }), 2.0f);
}

TEST(Segments, GraphsLinkNeighbors) {
  const std::vector<media::Medium> media{fog(0)};
  const auto segments = bundle(20, 10);
  const auto graph = segment_graph(segments, {media, 2, true});
  ASSERT_EQ(graph.nodes(), segments.size());
  for (std::size_t v = 0; v < graph.nodes(); ++v) {
    EXPECT_GE(graph.first[v + 1] - graph.first[v], 5);
    for (auto e = static_cast<std::size_t>(graph.first[v]); e < static_cast<std::size_t>(graph.first[v + 1]);
         ++e) {
      EXPECT_GT(graph.weight[e], 0);
      const Segment& other = segments[static_cast<std::size_t>(graph.neighbor[e])];
      EXPECT_LT(length(other.origin - segments[v].origin), 0.25f);
    }
  }
}

TEST(Segments, GroupsCoverEveryRayOnce) {
  const std::vector<media::Medium> media{fog(0)};
  const auto segments = bundle(60, 16);
  const SegmentSimilarity similarity(media, 20, true);
  for (const bool refine : {false, true})
    for (const bool merge : {false, true}) {
      SegmentGroupSettings settings;
      settings.groups = 8, settings.refine = refine, settings.merge = merge;
      const auto pieces = group_segments(segments, similarity, settings);
      std::set<std::uint32_t> groups;
      double covered = 0;
      // Where the last piece ended: (ray, place).
      int ray = -1;
      double at = 1;
      for (const SegmentPiece& p : pieces) {
        const Segment& s = segments[p.source];
        const double begin = static_cast<double>(s.origin.x + p.offset);
        if (begin < 1e-6) {
          EXPECT_NEAR(at, 1, 1e-5);
          ++ray, at = 0;
        }
        EXPECT_EQ(static_cast<int>(std::lround(s.film.x)), ray);
        EXPECT_NEAR(begin, at, 1e-5);
        at = begin + static_cast<double>(p.length), covered += static_cast<double>(p.length);
        groups.insert(p.group);
      }
      EXPECT_NEAR(covered, 60, 1e-3);
      EXPECT_EQ(groups.size(), 8u);
      if (merge) {
        EXPECT_LT(pieces.size(), segments.size());
      } else if (refine) {
        EXPECT_GT(pieces.size(), segments.size());
      } else {
        EXPECT_EQ(pieces.size(), segments.size());
      }
    }
}

TEST(Segments, WhatIsAlikeAlongARayIsPutTogether) {
  const std::vector<media::Medium> media{fog(0)};
  auto segments = bundle(3, 16);
  // The second ray has a gap, and the third goes from thin to thick fog in its middle.
  segments[16 + 5].joined = false;
  for (int k = 8; k < 16; ++k) segments[32 + k].transmittance = 0.05f;
  const SegmentSimilarity similarity(media, 4, true);
  const auto pieces = merge_segments(segments, similarity, 3);
  std::vector<std::vector<SegmentPiece>> of_rays(3);
  for (const SegmentPiece& p : pieces) of_rays[p.source / 16].push_back(p);
  for (const auto& pieces_of_ray : of_rays) {
    float length = 0;
    for (const SegmentPiece& p : pieces_of_ray) {
      EXPECT_EQ(p.offset, 0);
      EXPECT_NEAR(segments[p.source].origin.x, length, 1e-5);
      length += p.length;
    }
    EXPECT_NEAR(length, 1, 1e-5);
  }
  // Equations 10 and 12, both ends together no further off than an eighth of the diagonal.
  EXPECT_GT(of_rays[0].size(), 1u);
  EXPECT_LT(of_rays[0].size(), 8u);
  const auto begins_at = [](const std::vector<SegmentPiece>& list, std::uint32_t source) {
    return std::ranges::any_of(list, [=](const SegmentPiece& p) { return p.source == source; });
  };
  EXPECT_TRUE(begins_at(of_rays[1], 16 + 5));
  EXPECT_TRUE(begins_at(of_rays[2], 32 + 8));
  // Nothing is as alike as that.
  EXPECT_EQ(merge_segments(segments, similarity, similarity.most()).size(), segments.size());
}

}  // namespace
}  // namespace lumirank::transport
