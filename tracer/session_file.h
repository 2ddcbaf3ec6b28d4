// Saved sessions (.bvhscope): everything the user has set, as JSON. Its fields: session_fields.h.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/settings.h"

namespace tracer {

struct SavedSession {
  Settings settings;
  ViewOptions view;
  std::vector<std::string> warnings = {};  // what was ignored or brought into its range, when read

  bool operator==(const SavedSession&) const = default;
};

// Texture indices are not written; the pipeline takes the scene's own.
std::string session_json(const SavedSession& session);

// What is missing keeps its default. Throws Error ("file: settings.render.width: ...") for what is
// not JSON, of another type than expected, or of a later schema; `file` is for the message.
SavedSession parse_session(std::string_view json, std::string_view file);

// A scene or sky below the session's folder is stored relative to it, any other one absolute, so a
// folder with both can be moved. Throw Error.
void write_session(const std::filesystem::path& file, SavedSession session);
SavedSession read_session(const std::filesystem::path& file);

// Whether a name on the command line or a dropped file is a session: by its ending.
bool is_session_file(const std::filesystem::path& file);

}  // namespace tracer
