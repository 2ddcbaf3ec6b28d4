// The stroke font. A glyph is a list of polylines on a grid: each point is two digits, x then y,
// with y = 0 the top of capitals, 2 the top of small letters, 7 the base line and 9 the lowest
// descender; a blank begins a new polyline. A polyline of one point twice is a dot.
#include "tracer/render/text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tracer {
namespace {

constexpr char first_glyph = '!';
constexpr std::string_view glyphs[] = {
    "0004 0707",                         // !
    "0002 2022",                         // "
    "1017 3037 0242 0545",               // #
    "413010010213334446371706 2028",     // $
    "4007 0010110100 3646473736",        // %
    "47021120310506172745",              // &
    "0002",                              // '
    "10010617",                          // (
    "00111607",                          // )
    "2024 0143 0341",                    // *
    "0444 2226",                         // +
    "1708",                              // ,
    "0434",                              // -
    "0707",                              // .
    "3007",                              // /
    "103041463717060110",                // 0
    "112027 1737",                       // 1
    "01103041420747",                    // 2
    "01103041423313 334446371706",       // 3
    "37300545",                          // 4
    "400003334446371706",                // 5
    "413010010617374644331304",          // 6
    "004017",                            // 7
    "13020110304142331304061737464433",  // 8
    "061737464130100103143443",          // 9
    "0303 0707",                         // :
    "0303 0708",                         // ;
    "310437",                            // <
    "0343 0545",                         // =
    "013407",                            // >
    "01103041422425 2727",               // ?
    "34241525343536454130100106173747",  // @
    "072047 1535",                       // A
    "07003041423303 3344463707",         // B
    "4130100106173746",                  // C
    "00304146370700",                    // D
    "40000747 0333",                     // E
    "400007 0333",                       // F
    "41301001061737464424",              // G
    "0007 4047 0343",                    // H
    "0020 1017 0727",                    // I
    "3036271706",                        // J
    "0007 4004 1347",                    // K
    "000747",                            // L
    "0700234047",                        // M
    "07004740",                          // N
    "103041463717060110",                // O
    "07003041433404",                    // P
    "103041463717060110 2547",           // Q
    "07003041433404 2447",               // R
    "413010010213334446371706",          // S
    "0040 2027",                         // T
    "000617374640",                      // U
    "002740",                            // V
    "0017325760",                        // W
    "0047 4007",                         // X
    "002340 2327",                       // Y
    "00400747",                          // Z
    "10000717",                          // [
    "0037",                              // backslash
    "00101707",                          // ]
    "022042",                            // ^
    "0848",                              // _
    "0011",                              // `
    "12324347 44140506173746",           // a
    "0007 0312324346371706",             // b
    "4332120306173746",                  // c
    "4047 4332120306173746",             // d
    "04444332120306173746",              // e
    "30201117 0232",                     // f
    "4248391908 4332120306173746",       // g
    "0007 0312324347",                   // h
    "0207 0000",                         // i
    "121809 1010",                       // j
    "0007 3205 1437",                    // k
    "000617",                            // l
    "0207 0312223337 3342526367",        // m
    "0207 0312324347",                   // n
    "123243463717060312",                // o
    "0209 0312324346371706",             // p
    "4249 4332120306173746",             // q
    "0207 031232",                       // r
    "43321203143546371706",              // s
    "10162737 0232",                     // t
    "0206173746 4247",                   // u
    "022742",                            // v
    "0217335762",                        // w
    "0247 4207",                         // x
    "0227 4219",                         // y
    "02420747",                          // z
    "201113041527",                      // {
    "0009",                              // |
    "001113241507",                      // }
    "0413243342",                        // ~
};
constexpr std::string_view unknown_glyph = "0040470700";
constexpr float blank_advance = 4.0f;
constexpr float letter_gap = 1.9f;

std::string_view glyph(char letter) {
  const int index = letter - first_glyph;
  return index >= 0 && index < int(std::size(glyphs)) ? glyphs[index] : unknown_glyph;
}

float advance(char letter) {
  if (letter == ' ') return blank_advance;
  float widest = 0.0f;
  const std::string_view points = glyph(letter);
  for (size_t i = 0; i + 1 < points.size(); i += points[i] == ' ' ? 1 : 2) {
    if (points[i] != ' ') widest = std::max(widest, float(points[i] - '0'));
  }
  return widest + letter_gap;
}

struct Point {
  float x, y;
};

float distance(Point p, Point a, Point b) {
  const float dx = b.x - a.x;
  const float dy = b.y - a.y;
  const float length2 = dx * dx + dy * dy;
  const float along = length2 > 0.0f ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / length2 : 0.0f;
  const float t = std::clamp(along, 0.0f, 1.0f);
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

// The corner points of a glyph's polylines as segments, in pixels.
struct Segment {
  Point from, to;
};
int segments_of(std::string_view points, Point origin, float unit, std::array<Segment, 32>& out) {
  int count = 0;
  bool begun = false;
  Point last{};
  for (size_t i = 0; i + 1 < points.size() && count < int(out.size());) {
    if (points[i] == ' ') {
      begun = false;
      ++i;
      continue;
    }
    const Point point{origin.x + float(points[i] - '0') * unit,
                      origin.y + float(points[i + 1] - '0') * unit};
    if (begun) out[count++] = {last, point};
    last = point;
    begun = true;
    i += 2;
  }
  return count;
}

}  // namespace

float text_width(std::string_view text, float unit) {
  float width = 0.0f;
  for (const char letter : text)
    width += advance(letter);
  return text.empty() ? 0.0f : (width - letter_gap + 1.0f) * unit;
}

void draw_text(Image& image, float x, float y, std::string_view text, float unit, uint32_t color) {
  const float half_stroke = std::max(0.55f, 0.48f * unit);
  std::array<Segment, 32> segments;
  for (const char letter : text) {
    // Stems through pixel centres are crisp.
    const Point origin{std::floor(x) + 0.5f, std::floor(y) + 0.5f};
    x += advance(letter) * unit;
    if (letter == ' ') continue;
    const int count = segments_of(glyph(letter), origin, unit, segments);
    const int x1 = std::min(image.width, int(origin.x + advance(letter) * unit) + 1);
    const int y1 = std::min(image.height, int(origin.y + 10.0f * unit) + 1);
    for (int row = std::max(0, int(origin.y) - 1); row < y1; ++row) {
      for (int column = std::max(0, int(origin.x) - 1); column < x1; ++column) {
        float nearest = 1e9f;
        const Point centre{float(column) + 0.5f, float(row) + 0.5f};
        for (int i = 0; i < count; ++i) {
          nearest = std::min(nearest, distance(centre, segments[i].from, segments[i].to));
        }
        const float cover = std::clamp(half_stroke + 0.5f - nearest, 0.0f, 1.0f);
        if (cover == 0.0f) continue;
        uint32_t& pixel = image.pixels[size_t(row) * image.width + column];
        pixel = mixed(pixel, opaque(color), cover);
      }
    }
  }
}

}  // namespace tracer
