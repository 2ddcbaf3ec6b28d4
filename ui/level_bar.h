// A row of segments, one a level, of which a range is chosen.
#pragma once

namespace ui {

// Levels 0 .. levels - 1. A click chooses one, a drag or a click with Shift those between; true in
// a frame in which the range changes.
bool level_bar(const char* label, int& first, int& last, int levels, const char* help);

}  // namespace ui
