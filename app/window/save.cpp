#include "app/window/save.h"

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include "app/window/painter.h"
#include "tracer/error.h"
#include "tracer/render/image_io.h"

namespace app {
namespace {

namespace fs = std::filesystem;

std::vector<tracer::vec3> radiance(const tracer::Film& film) {
  std::vector<tracer::vec3> result;
  result.reserve(size_t(film.width) * film.height);
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x)
      result.push_back(tracer::pixel(film, x, y).radiance);
  }
  return result;
}

bool is_writable_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder, error) && access(folder.c_str(), W_OK) == 0;
}

}  // namespace

std::string save_picture(std::shared_ptr<const tracer::Snapshot> snapshot, tracer::ViewOptions view,
                         const tracer::BoxSources& boxes, const fs::path& file) {
  const tracer::Film& film = snapshot->film;
  if (film.tiles.empty()) throw tracer::Error(file.string() + ": there is no picture to save yet");
  const std::string ending = file.extension().string();
  if (ending == ".exr" || ending == ".hdr") {
    tracer::write_float_image(file, film.width, film.height, radiance(film));
    return fmt::format("Saved linear radiance, {} x {} pixels, as {}", film.width, film.height,
                       file.string());
  }
  view.legend = true;
  tbb::task_arena alone(1);  // TBB's workers may be busy tracing
  const Painting painting = alone.execute([&] { return paint(snapshot, view, boxes); });
  if (!painting.picture) throw tracer::Error(file.string() + ": " + painting.error);
  tracer::write_png(file, painting.picture->image);
  return fmt::format("Saved the picture, {} x {} pixels, as {}", film.width, film.height,
                     file.string());
}

fs::path new_screenshot_name() {
  fs::path folder;
  if (const char* home = std::getenv("HOME")) folder = fs::path(home) / "Pictures";
  std::error_code error;
  if (!is_writable_folder(folder)) folder = fs::current_path(error);
  const std::string stem =
      fmt::format("bvhscope-{:%Y-%m-%d-%H%M%S}", fmt::localtime(std::time({})));
  fs::path file = folder / (stem + ".png");
  for (int i = 2; fs::exists(file, error); ++i) {
    file = folder / fmt::format("{}-{}.png", stem, i);
  }
  return file;
}

}  // namespace app
