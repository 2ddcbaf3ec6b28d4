// GLFW's keys as the workspace's.
#pragma once

namespace app {

// A ui::Key, or an ASCII code. `name` is what is printed on the key (UTF-8), or nullptr: a letter
// goes by its name, so Ctrl+Z is where the user's keyboard has its Z; all else goes by position.
int key_code(int glfw_key, const char* name);

}  // namespace app
