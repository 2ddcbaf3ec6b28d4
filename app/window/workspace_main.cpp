#include "app/window/workspace_main.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include <imgui.h>

#include "app/window/frame_times.h"
#include "app/window/gui.h"
#include "app/window/save.h"
#include "app/window/window.h"
#include "app/window/workspace.h"
#include "app/window/workspace_file.h"
#include "tracer/error.h"
#include "tracer/render/image_io.h"

namespace app {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<float, std::milli>;

constexpr Clock::duration frame_interval = std::chrono::microseconds(16667);
constexpr Clock::duration remember_interval = std::chrono::seconds(2);
constexpr double idle_seconds = 0.25;  // between looks at whether something is to be done
constexpr int settle_frames = 4;       // drawn after the last event: ImGui comes to rest late

// The file of the last start, and when it was written last.
class Memory {
 public:
  // What was remembered, and a notice for the Messages panel if there was trouble.
  Recalled recall_workspace() {
    if (!file_) return {{}, "neither HOME nor XDG_CONFIG_HOME is set: the layout is not kept"};
    Recalled recalled = recall(*file_);
    last_ = recalled.remembered;
    return recalled;
  }

  void save(Workspace& workspace, const Window& window) {
    next_ = Clock::now() + remember_interval;
    const tracer::ivec2 size = window.size();
    Remembered now{size.x, size.y, ui::layout_to_json(workspace.state)};
    if (!file_ || failed_ || now == last_ || size.x == 0) return;
    last_ = std::move(now);
    try {
      remember(*file_, last_);
    } catch (const tracer::Error& error) {
      failed_ = true;
      ui::post(workspace.state, ui::Severity::warning,
               std::string("The layout is not kept: ") + error.what());
    }
  }
  void save_if_due(Workspace& workspace, const Window& window) {
    if (Clock::now() >= next_) save(workspace, window);
  }

 private:
  const std::optional<std::filesystem::path> file_ = workspace_file();
  Remembered last_;
  bool failed_ = false;
  Clock::time_point next_ = Clock::now() + remember_interval;
};

float wanted_scale(const Workspace& workspace, const Window& window) {
  const float chosen = workspace.state.user_scale;
  return chosen > 0.0f ? chosen : window.content_scale();
}

void save_screenshot(Workspace& workspace, tracer::ivec2 size) {
  workspace.chores.add([image = read_framebuffer(size.x, size.y)] {
    const std::filesystem::path file = new_screenshot_name();
    tracer::write_png(file, image);
    return "Saved a picture of the window as " + file.string();
  });
}

void draw_frame(Workspace& workspace, Window& window, Gui& gui, float frame_ms) {
  const float scale = wanted_scale(workspace, window);
  gui.set_scale(scale);
  workspace.state.scale = scale;
  workspace.state.held = window.held();
  for (const std::string& name : window.take_dropped())
    open(workspace, name);
  receive(workspace);

  window.begin_frame();
  gui.begin_frame();
  ui::Frame frame{*workspace.snapshot,
                  workspace.painting->picture.get(),
                  workspace.texture.texture(),
                  frame_ms,
                  window.take_keys(),
                  workspace.edited,
                  workspace.state,
                  workspace.requests,
                  work_of(workspace.background)};
  ui::draw_workspace(frame);
  const tracer::ivec2 size = window.framebuffer();
  gui.end_frame(size.x, size.y);

  if (workspace.requests.screenshot) save_screenshot(workspace, size);
  workspace.requests.screenshot = false;
  carry_out(workspace);
  send(workspace);
  window.show();
}

// Draws while something happens and sleeps when nothing does.
FrameTimes run_frames(Workspace& workspace, Window& window, Gui& gui, Memory& memory,
                      std::atomic<bool>& woken, int frames) {
  FrameTimes times;
  float smooth_ms = 0.0f;
  int settle = settle_frames;
  Clock::time_point next = Clock::now();
  for (int drawn = 0; !window.closing() && !workspace.closing && (frames == 0 || drawn < frames);) {
    std::this_thread::sleep_until(next);
    const bool at_once = settle > 0 || workspace.state.animating || frames > 0;
    window.handle_events(at_once ? 0.0 : idle_seconds);
    if (window.framebuffer().x == 0 || window.framebuffer().y == 0) {
      window.handle_events(idle_seconds);
      continue;
    }
    // A text cursor blinks without any event.
    const bool blinks = ImGui::GetIO().WantTextInput;
    // While a picture is refined or times are measured, each piece of news is worth one frame:
    // drawing more would take the processors from those who work.
    const bool news = woken.exchange(false);
    const bool working = workspace.session.busy() || workspace.background.turns.measuring();
    if (news) settle = std::max(settle, working ? 1 : settle_frames);
    if (window.take_happened()) settle = settle_frames;
    if (settle == 0 && !workspace.state.animating && !blinks && frames == 0) continue;
    settle = std::max(settle - 1, 0);

    const Clock::time_point began = Clock::now();
    next = std::max(began, next + frame_interval);
    const ui::Edited before = workspace.edited;
    const bool tracing = workspace.session.busy();
    const auto painting = workspace.painting;
    draw_frame(workspace, window, gui, smooth_ms);
    if (workspace.painting != painting) {
      times.pictures.push_back(float(workspace.painting->milliseconds));
    }
    if (workspace.edited != before) settle = settle_frames;
    const float ms = Milliseconds(Clock::now() - began).count();
    smooth_ms = drawn == 0 ? ms : smooth_ms + 0.1f * (ms - smooth_ms);
    (tracing ? times.tracing : times.idle).push_back(ms);
    ++drawn;
    memory.save_if_due(workspace, window);
  }
  return times;
}

void run(const WorkspaceOptions& options) {
  Memory memory;
  const Recalled recalled = memory.recall_workspace();
  const Remembered& remembered = recalled.remembered;
  const auto side = [](int asked, int last, int otherwise) {
    return asked > 0 ? asked : last > 0 ? last : otherwise;
  };
  Window window("bvhscope", side(options.width, remembered.width, 1600),
                side(options.height, remembered.height, 900));
  Gui gui(window.content_scale());
  window.attach_gui();
  {
    std::atomic<bool> woken = false;
    Workspace workspace([&woken] {
      woken = true;
      Window::wake();
    });
    workspace.edited = {options.settings, options.view};
    ui::layout_from_json(workspace.state, remembered.layout);
    if (options.scale > 0.0f) workspace.state.user_scale = options.scale;
    if (!recalled.notice.empty()) {
      ui::post(workspace.state, ui::Severity::warning, recalled.notice);
    }
    const FrameTimes times = run_frames(workspace, window, gui, memory, woken, options.frames);
    memory.save(workspace, window);
    if (options.timings) std::fputs(to_text(times).c_str(), stdout);
  }
  window.detach_gui();
}

}  // namespace

bool has_display() {
  const auto set = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0';
  };
  return set("DISPLAY") || set("WAYLAND_DISPLAY");
}

int run_workspace(const WorkspaceOptions& options) {
  try {
    run(options);
    return 0;
  } catch (const tracer::Error& error) {
    std::fprintf(stderr,
                 "bvhscope: no window can be opened (%s); the commands \"render\" and "
                 "\"screenshot\" draw without one, see --help\n",
                 error.what());
    return 1;
  }
}

}  // namespace app
