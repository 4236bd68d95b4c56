#include <png.h>

#include <csetjmp>
#include <cstring>
#include <memory>

#include "evenmesh/render.h"

namespace evenmesh {
namespace {

void append(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

void check(const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw InvalidInput("an image needs three bytes for each of its pixels, and at least one pixel");
}

/// libpng reports errors by a jump: nothing with a destructor may live in here.
bool write_png(const Image& image, png_structp png, png_infop info, std::string* out) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, out, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  for (int row = 0; row < image.height; ++row)
    png_write_row(png, image.rgb.data() + 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(row));
  png_write_end(png, info);
  return true;
}

}  // namespace

Image beside(const std::vector<Image>& images) {
  if (images.empty()) throw InvalidInput("there must be at least one picture to put beside others");
  Image result;
  for (const Image& image : images) {
    check(image);
    result.width += image.width;
    result.height = std::max(result.height, image.height);
  }
  result.rgb.assign(3 * static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height), 255);
  std::size_t left = 0;
  for (const Image& image : images) {
    const std::size_t bytes = 3 * static_cast<std::size_t>(image.width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(image.height); ++row)
      std::memcpy(result.rgb.data() + 3 * (row * static_cast<std::size_t>(result.width)) + left,
                  image.rgb.data() + row * bytes, bytes);
    left += bytes;
  }
  return result;
}

std::string encode_png(const Image& image) {
  check(image);
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool written = info && write_png(image, png, info, &out);
  png_destroy_write_struct(&png, &info);
  if (!written) throw Error("the picture could not be encoded as PNG");
  return out;
}

}  // namespace evenmesh
