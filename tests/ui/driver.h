// Drives the real workspace without a window: the test owns the frame loop, finds widgets by label
// and moves the mouse. Nothing is drawn to anywhere.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ui/registry.h"
#include "ui/workspace_state.h"

namespace ui {

class Driver {
 public:
  // The named scene, traced at a small fixed size; an empty name: nothing is loaded.
  explicit Driver(std::string_view scene = "showcase", ImVec2 display = {1400, 900});
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  // What the frame loop of the program does between frames: traces what has been edited.
  void trace();
  void frame(int count = 1);

  // Brings a panel to the front.
  void show(std::string_view panel);

  // The item with this label, scrolled to; fails the test when it is not there within 60 frames.
  Item find(const std::string& label);
  bool is_there(const std::string& label);
  ImVec2 middle(const std::string& label);

  void move_to(ImVec2 at);
  void click_at(ImVec2 at, int button = 0);
  void drag(ImVec2 from, ImVec2 to, int button = 0);

  void hover(const std::string& label);
  void click(const std::string& label, int button = 0);
  void double_click(const std::string& label);
  // From the middle of the item by `x`, `y` pixels.
  void drag(const std::string& label, float x, float y = 0.0f, int button = 0);
  void choose(const std::string& combo, const std::string& id);
  void menu(std::initializer_list<const char*> path);

  void press(int key, bool control = false, bool shift = false);
  void hold(int key, bool down);
  void type(std::string_view text);  // then Enter for '\n'
  void wheel(float steps);

  // Everything that is not in `edited`, as text: to see whether something has changed.
  std::string digest() const;

  Edited edited;
  UiState state;
  Requests requests;
  Work work;
  Registry items;
  std::shared_ptr<const tracer::Snapshot> snapshot;
  tracer::Picture picture;
  bool has_picture = false;
  bool shift = false, control = false;  // held

 private:
  void send(ImVec2 mouse);

  ImGuiContext* context_ = nullptr;
  tracer::Pipeline pipeline_;
  ImVec2 display_;
  ImVec2 mouse_{-1, -1};
  bool down_[3] = {};
  float wheel_ = 0.0f;
  bool enter_ = false;
  std::vector<KeyPress> keys_;
};

}  // namespace ui
