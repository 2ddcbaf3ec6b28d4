// MTL material libraries, through tinyobjloader. The text is written anew before, because that
// parser reads "Kd 0.5" as red, loses the file name after "-o 0.1" and cannot tell "not given".
#include "tracer/scene/load_mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "tracer/scene/obj_number.h"

namespace tracer {
namespace {

constexpr size_t longest_line = 4096;
constexpr float not_given = -1.0f;

struct Key {
  std::string_view name;
  int numbers;        // 0: not a numeric key
  double most = 1e6;  // of each number; the least is 0
};
constexpr std::array<Key, 13> keys = {{{"newmtl", 0},
                                       {"Ka", 3},
                                       {"Kd", 3, 1.0},
                                       {"Ks", 3, 1.0},
                                       {"Ke", 3},
                                       {"Tf", 3, 1.0},
                                       {"Ns", 1},
                                       {"Ni", 1},
                                       {"d", 1, 1.0},
                                       {"Tr", 1, 1.0},
                                       {"illum", 1},
                                       {"map_Kd", 0},
                                       {"map_d", 0}}};

const Key* find_key(std::string_view word) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
  for (const Key& key : keys) {
    if (std::equal(word.begin(), word.end(), key.name.begin(), key.name.end(),
                   [&](char a, char b) { return lower(a) == lower(b); })) {
      return &key;
    }
  }
  return nullptr;
}

// Up to `most` numbers off the front of `rest`.
std::vector<double> take_numbers(std::string_view& rest, size_t most) {
  std::vector<double> numbers;
  while (numbers.size() < most) {
    std::string_view after = rest;
    const Number number = parse_number(next_word(after));
    if (number.fault == NumberFault::bad) break;
    numbers.push_back(number.value);
    rest = after;
  }
  return numbers;
}

// Options with all their numbers written out, then the file name with its blanks.
std::string texture_line(std::string_view rest) {
  std::string line;
  for (;;) {
    std::string_view after = rest;
    const std::string_view option = next_word(after);
    if (option.size() < 2 || option.front() != '-') break;
    if (option == "-o" || option == "-s" || option == "-t") {
      std::vector<double> numbers = take_numbers(after, 3);
      numbers.resize(3, option == "-s" ? 1.0 : 0.0);
      line += option;
      for (const double number : numbers)
        line += fmt::format(" {}", number_word(number));
      line += ' ';
    } else if (option == "-mm") {
      take_numbers(after, 2);
    } else if (option == "-bm" || option == "-boost" || option == "-texres") {
      take_numbers(after, 1);
    } else if (option == "-blendu" || option == "-blendv" || option == "-clamp" ||
               option == "-cc" || option == "-imfchan" || option == "-type" ||
               option == "-colorspace") {
      next_word(after);
    } else {
      break;  // a file name that begins with a minus
    }
    rest = after;
  }
  return line + std::string(trimmed(rest));
}

// One line as tinyobjloader reads it right; empty: nothing for it.
std::string cleaned_line(std::string_view line, uint64_t number_of_line, MtlFile& file) {
  std::string_view rest = line;
  const Key* key = find_key(next_word(rest));
  if (!key) return {};
  const std::string name(key->name);
  if (name == "newmtl") {
    const std::string_view material = trimmed(rest);
    return fmt::format("newmtl {}\nKd -1 -1 -1\nNi -1\n",
                       material.empty() ? "(no name)" : material);
  }
  if (key->numbers == 0) return fmt::format("{} {}\n", name, texture_line(rest));
  if (name == "d") {
    std::string_view after = rest;
    if (next_word(after) == "-halo") rest = after;
  }
  std::vector<double> numbers = take_numbers(rest, size_t(key->numbers));
  // A number that is none: the line says nothing. One number for three means all of them.
  const bool complete = numbers.size() == size_t(key->numbers) || numbers.size() == 1;
  const std::string_view after = next_word(rest);
  const bool other_text = !after.empty() && parse_number(after).fault == NumberFault::bad;
  if (!complete || other_text) add(file.bad_numbers, number_of_line);
  if (numbers.empty()) return {};
  numbers.resize(size_t(key->numbers), numbers.front());
  std::string result = name;
  bool in_range = true;
  for (const double number : numbers) {
    in_range = in_range && number >= 0.0 && number <= key->most;
    result += fmt::format(" {}", number_word(std::clamp(number, 0.0, key->most)));
  }
  if (!in_range) add(file.out_of_range, number_of_line);
  return result + "\n";
}

std::string cleaned(std::string_view text, MtlFile& file) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  std::string result;
  bool in_material = false;
  std::map<std::string, std::string> first;  // the cleaned text of each name's first material
  std::string name;
  size_t begin = 0;  // of the material at hand in the result
  uint64_t begin_line = 0;
  const auto finish = [&] {
    const auto [known, is_new] = first.try_emplace(name, result.substr(begin));
    if (!is_new && known->second != result.substr(begin)) add(file.repeated, begin_line);
  };
  for (uint64_t number = 1; !text.empty(); ++number) {
    const size_t end = text.find_first_of("\r\n");
    const std::string_view line = trimmed(text.substr(0, end));
    const bool two = end != text.npos && text.substr(end, 2) == "\r\n";
    text.remove_prefix(end == text.npos ? text.size() : end + (two ? 2 : 1));
    if (line.size() > longest_line || line.find('\0') != line.npos) continue;
    const std::string clean = cleaned_line(line, number, file);
    if (clean.starts_with("newmtl ")) {
      if (in_material) finish();
      in_material = true;
      name = clean;
      begin = result.size();
      begin_line = number;
    }
    if (in_material) result += clean;
  }
  if (in_material) finish();
  return result;
}

vec3 color(const tinyobj::real_t* rgb, float most) {
  return glm::clamp(vec3(rgb[0], rgb[1], rgb[2]), 0.0f, most);
}
float mean(const vec3& v) {
  return (v.x + v.y + v.z) / 3.0f;
}
float largest(const vec3& v) {
  return std::max({v.x, v.y, v.z});
}
vec3 tint(const vec3& v) {
  return largest(v) > 0.0f ? v / largest(v) : vec3(1.0f);
}

// As the MTL specification numbers its illumination models.
bool is_mirror(int illum) {
  return illum == 3 || illum == 5;
}
bool is_glass(int illum) {
  return illum == 4 || illum == 6 || illum == 7 || illum == 9;
}

// d mixes the surface with what is behind it. A glass without d is as clear as it is not coloured.
void set_transmission(const tinyobj::material_t& from, Material& to) {
  const float opacity = std::clamp(from.dissolve, 0.0f, 1.0f);
  const vec3 filter = color(from.transmittance, 1.0f);
  if (opacity < 1.0f) {
    to.transmission = 1.0f - opacity;
  } else if (is_glass(from.illum)) {
    to.transmission = largest(filter) > 0.0f ? largest(filter) : 1.0f - largest(to.albedo);
  }
  if (is_glass(from.illum) && largest(filter) > 0.0f) to.specular = tint(filter);
  if (from.ior != not_given) {
    to.refraction_index = std::clamp(from.ior, 1.0f, 3.0f);
  } else if (to.transmission > 0.0f && !is_glass(from.illum)) {
    to.refraction_index = 1.0f;  // blended as a thin pane is: straight through
  }
}

MtlMaterial converted(const tinyobj::material_t& from) {
  MtlMaterial result;
  Material& to = result.material;
  to.name = from.name;
  result.texture = from.diffuse_texname;
  result.has_alpha_map = !from.alpha_texname.empty();
  const bool has_texture = !result.texture.empty();
  const bool has_diffuse =
      from.diffuse[0] != not_given || from.diffuse[1] != not_given || from.diffuse[2] != not_given;
  if (has_diffuse) to.albedo = color(from.diffuse, 1.0f);
  // Nobody means a texture times black.
  if (has_texture && (!has_diffuse || largest(to.albedo) == 0.0f)) to.albedo = vec3(1.0f);
  to.emission = color(from.emission, 1e6f);

  set_transmission(from, to);
  if (is_mirror(from.illum)) {
    const vec3 specular = color(from.specular, 1.0f);
    to.reflectivity = std::min(mean(specular), 1.0f - to.transmission);
    if (to.reflectivity > 0.0f) to.specular = tint(specular);
  }

  result.uv_scale = vec2(from.diffuse_texopt.scale[0], from.diffuse_texopt.scale[1]);
  result.uv_offset =
      vec2(from.diffuse_texopt.origin_offset[0], from.diffuse_texopt.origin_offset[1]);
  return result;
}

}  // namespace

MtlFile parse_mtl(std::string_view text) {
  MtlFile result;
  const std::string clean = cleaned(text, result);
  if (clean.empty()) return result;
  std::istringstream stream(clean);
  std::map<std::string, int> ids;
  std::vector<tinyobj::material_t> materials;
  std::string warnings;
  std::string errors;
  tinyobj::LoadMtl(&ids, &materials, &stream, &warnings, &errors);
  for (const tinyobj::material_t& material : materials) {
    if (!material.name.empty()) result.materials.emplace(material.name, converted(material));
  }
  return result;
}

}  // namespace tracer
