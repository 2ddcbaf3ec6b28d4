#include "app/window/keys.h"

#include <cctype>

#include <GLFW/glfw3.h>

#include "ui/workspace.h"

namespace app {

int key_code(int glfw_key, const char* name) {
  switch (glfw_key) {
    case GLFW_KEY_ESCAPE:
      return ui::key_escape;
    case GLFW_KEY_F1:
      return ui::key_f1;
    case GLFW_KEY_F5:
      return ui::key_f5;
    case GLFW_KEY_F12:
      return ui::key_f12;
    case GLFW_KEY_DELETE:
      return ui::key_delete;
    case GLFW_KEY_SPACE:
      return ui::key_space;
    case GLFW_KEY_LEFT:
      return ui::key_left;
    case GLFW_KEY_RIGHT:
      return ui::key_right;
    case GLFW_KEY_HOME:
      return ui::key_home;
    case GLFW_KEY_END:
      return ui::key_end;
    default:
      break;
  }
  if (name != nullptr && name[0] != '\0' && name[1] == '\0' &&
      std::isalpha(static_cast<unsigned char>(name[0])) != 0) {
    return std::toupper(static_cast<unsigned char>(name[0]));
  }
  // GLFW names printable keys by their ASCII code on a US keyboard.
  return glfw_key > GLFW_KEY_SPACE && glfw_key <= GLFW_KEY_GRAVE_ACCENT ? glfw_key : ui::key_other;
}

}  // namespace app
