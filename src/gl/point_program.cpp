#include "gl/point_program.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace evenmesh::gl {
namespace {

constexpr std::size_t smallest_chunk = 64, largest_chunk = std::size_t{1} << 20;  ///< values per dispatch
constexpr double longest_dispatch = 0.25;                                         ///< seconds, aimed at

}  // namespace

PointProgram::PointProgram(std::shared_ptr<Context> context, const std::string& text, const std::string& name)
    : context_(std::move(context)),
      what_("the shader " + name),
      program_(Program::compute(context_, text, name)),
      late_(context_, 1) {
  late_.fill_with_zeros();
}

void PointProgram::reserve(std::size_t points, std::size_t values) {
  if (points_.size() < 3 * points) points_ = Buffer<float>(context_, 3 * points);
  if (values_.size() < values) values_ = Buffer<float>(context_, values);
}

void PointProgram::learn(std::size_t values, double seconds) {
  if (values < chunk_) return;
  if (seconds < longest_dispatch / 4) chunk_ = std::min(chunk_ * 4, largest_chunk);
  if (seconds > longest_dispatch) chunk_ = std::max(chunk_ / 4, smallest_chunk);
}

std::uint32_t PointProgram::run(const PointBatch& points, unsigned layers, std::span<const std::span<float>> values) {
  const std::size_t rows = values.size();
  for (std::size_t done = 0; done < points.x.size();) {
    const std::size_t count = std::min(std::max<std::size_t>(chunk_ / rows, 1), points.x.size() - done);
    reserve(count, count * rows);
    points_.upload(points.x.subspan(done, count), 0);
    points_.upload(points.y.subspan(done, count), count);
    points_.upload(points.z.subspan(done, count), 2 * count);
    points_.bind(0);
    values_.bind(1);
    late_.bind(2);
    program_.set("em_count", static_cast<std::uint32_t>(count));
    const auto start = std::chrono::steady_clock::now();
    program_.dispatch(what_, static_cast<unsigned>((count + group - 1) / group), layers);
    context_->finish(what_);
    learn(count * rows, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    for (std::size_t row = 0; row < rows; ++row) values_.download(values[row].subspan(done, count), row * count);
    std::uint32_t late = 0;
    late_.download({&late, 1});
    if (late != 0) {
      late_.fill_with_zeros();
      return late;
    }
    done += count;
  }
  return 0;
}

}  // namespace evenmesh::gl
