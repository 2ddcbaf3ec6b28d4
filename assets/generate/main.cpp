// Writes bricks.png and sky.hdr into the folder given.
#include <cstdio>
#include <string>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include "assets/generate/generate.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: asset_generator FOLDER\n", stderr);
    return 2;
  }
  using namespace assets;
  const std::string folder = argv[1];
  const auto bricks = make_bricks();
  const auto sky = make_sky();
  if (!stbi_write_png((folder + "/bricks.png").c_str(), bricks_size, bricks_size, 3, bricks.data(),
                      3 * bricks_size) ||
      !stbi_write_hdr((folder + "/sky.hdr").c_str(), sky_width, sky_height, 3, &sky[0].x)) {
    std::fprintf(stderr, "%s: cannot write there; give an existing folder\n", folder.c_str());
    return 1;
  }
  return 0;
}
