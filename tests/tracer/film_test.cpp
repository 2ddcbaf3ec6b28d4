#include "tracer/render/film.h"

#include <gtest/gtest.h>

#include "tests/tracer/hand_made.h"

namespace tracer {
namespace {

PixelContent marked(int x, int y) {
  PixelContent pixel;
  pixel.hit.t = float(x + 1000 * y);
  pixel.depth = uint8_t(x % 256);
  pixel.radiance = vec3(x, y, 0);
  return pixel;
}

TEST(Film, GivesThePixelThatWasStored) {
  const Film film = hand_made_film(130, 70, marked);
  EXPECT_EQ(pixel(film, 0, 0).hit->t, 0.0f);
  EXPECT_EQ(pixel(film, 64, 0).hit->t, 64.0f);
  EXPECT_EQ(pixel(film, 129, 69).hit->t, 69129.0f);
  EXPECT_EQ(pixel(film, 129, 69).depth, 129);
}

TEST(Film, CoarseBlockShowsItsUpperLeftSample) {
  const Film film = hand_made_film(70, 70, marked, 8);
  EXPECT_EQ(pixel(film, 7, 7).hit->t, 0.0f);
  EXPECT_EQ(pixel(film, 8, 7).hit->t, 8.0f);
  EXPECT_EQ(pixel(film, 69, 69).hit->t, 64064.0f);
}

TEST(Film, NothingOutsideAndNothingBeforeTheFirstSample) {
  const Film film = hand_made_film(10, 10, marked);
  EXPECT_EQ(pixel(film, -1, 0).hit, nullptr);
  EXPECT_EQ(pixel(film, 10, 0).hit, nullptr);
  EXPECT_EQ(pixel(film, 0, 10).hit, nullptr);
  EXPECT_EQ(pixel(empty_film(10, 10), 0, 0).hit, nullptr);
  EXPECT_EQ(pixel(Film{}, 0, 0).hit, nullptr);
}

TEST(Film, RadianceIsTheMeanOverThePasses) {
  Film film = hand_made_film(2, 1, marked);
  FilmTile tile = *film.tiles[0];
  tile.sum = {vec3(8), vec3(4)};
  tile.samples = 4;
  film.tiles[0] = std::make_shared<const FilmTile>(tile);
  EXPECT_EQ(pixel(film, 0, 0).radiance, vec3(2));
  EXPECT_EQ(pixel(film, 1, 0).radiance, vec3(1));
}

}  // namespace
}  // namespace tracer
