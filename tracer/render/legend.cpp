// The legend of a picture that shows values.
#include "tracer/choice.h"
#include "tracer/render/color_bar.h"
#include "tracer/render/colorize.h"
#include "tracer/render/colormap.h"

namespace tracer {

void draw_legend(Picture& picture, const ViewOptions& options) {
  const ColormapRow* map = find_row(colormaps(), options.colormap);
  if (!picture.has_range || map == nullptr) return;
  ColorBar bar;
  bar.title = picture.title;
  bar.note = picture.unit;
  bar.range = picture.range;
  bar.counts = picture.counts;
  bar.logarithmic = options.logarithmic;
  bar.more = picture.histogram.range.hi > picture.range.hi;
  bar.color = map->color;
  draw_color_bar(picture.image, bar, Side::left);
}

}  // namespace tracer
