/// Points as text: XYZ, PTS, PWN. A point a line; what the columns mean is found from their number and their values.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <optional>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "io/formats.h"
#include "io/text.h"

namespace evenmesh {
namespace {

/// Files are read in pieces of about this many bytes, in parallel; pieces do not depend on the number of threads.
constexpr std::size_t piece_size = 1 << 20;
/// Coordinates, and two triples that may be a normal; what follows is passed over.
constexpr std::size_t kept_columns = 9;

// ---- Lines ----------------------------------------------------------------------------------------------------------

/// First byte that is neither blank nor in a comment.
const char* skip_to_row(const char* p, const char* end) {
  while (true) {
    while (p < end && is_blank(*p)) ++p;
    const bool comment = p < end && (*p == '#' || (*p == '/' && end - p > 1 && p[1] == '/'));
    if (p == end || (*p != '\n' && !comment)) return p;
    p = next_line(p, end);
  }
}

/// The numbers of a line, apart by blanks or one comma or semicolon.
struct Row {
  std::array<double, kept_columns> values{};
  std::size_t columns = 0;
  const char* wrong = nullptr;  ///< where something else than a number is
  std::array<char, 2> mixed{};  ///< two that both stand between its numbers, as blanks and commas

  Vec3 triple(std::size_t first) const { return {values[first], values[first + 1], values[first + 2]}; }
};

/// Moves behind what stands between two numbers and tells it: ' ', ',', ';', '\n' for the end of the row, 0 for
/// nothing.
inline char skip_separator(const char*& p, const char* end) {
  const auto skip_blanks = [&] {
    while (p < end && is_blank(*p)) ++p;
    return p == end || *p == '\n' || *p == '#';
  };
  const char* from = p;
  if (skip_blanks()) return '\n';
  const char c = *p;
  if (c != ',' && c != ';') return p > from ? ' ' : '\0';
  ++p;
  return skip_blanks() ? '\n' : c;
}

Row scan_row(const char*& p, const char* end) {
  Row row;
  char first = '\0', separator = '\0';  // in front of the second number, and of this one
  while (true) {
    const char* from = p;
    double value = 0;
    const bool number = scan_number(p, end, value);
    const char next = number ? skip_separator(p, end) : '\0';
    if (next == '\0') {
      row.wrong = from;
      return row;
    }
    if (row.columns < kept_columns) row.values[row.columns] = value;
    ++row.columns;
    if (first == '\0') first = separator;
    if (separator != first) row.mixed = {first, separator};
    if (next == '\n') return row;
    separator = next;
  }
}

/// The number of points, if a row is one whole number and nothing else.
std::optional<std::uint64_t> count_of(const char* p, const char* end) {
  std::int64_t count = 0;
  if (!scan_integer(p, end, count) || count < 0 || skip_separator(p, end) != '\n') return {};
  return static_cast<std::uint64_t>(count);
}

// ---- The file -------------------------------------------------------------------------------------------------------

struct Layout {
  std::optional<std::uint64_t> count;  ///< of points, as announced
  const char* begin = nullptr;         ///< the first point
  std::size_t columns = 0;
};

struct Piece {
  const char* begin = nullptr;
  const char* end = nullptr;
  std::vector<Vec3> points;
  std::array<std::vector<Vec3>, 2> triples;  ///< columns 4 to 6, and 7 to 9, where there are so many
  std::exception_ptr error;
};

const char* name_of_separator(char c) {
  return c == ',' ? "commas" : c == ';' ? "semicolons" : "blanks";
}

void require_numbers(const Source& source, const Row& row, const char* begin) {
  if (const auto [first, second] = row.mixed; first != second) {
    fail_at(source, begin,
            fmt::format("its numbers stand apart by {} and by {}; use one of them, and write decimal numbers with a "
                        "point (1.5, not 1,5)",
                        name_of_separator(first), name_of_separator(second)));
  }
  if (row.wrong) {
    fail_at(source, row.wrong,
            fmt::format("expected {}, found {}", row.columns < 3 ? "a coordinate of the point" : "a number",
                        found_at(source, row.wrong)));
  }
}

/// How sure one must be that a line holds the titles of columns.
enum class Titles { surely, likely };

/// Whether a line begins with a word, and the next row with three numbers; surely, if there are as many of each.
bool is_title(const char* p, const char* end, Titles how) {
  const char* next = next_line(p, end);
  std::string_view line(p, static_cast<std::size_t>(next - p));
  line = line.substr(0, line.find_last_not_of(" \t\r\n") + 1);
  const char* q = p;
  double number = 0;
  if (line.empty() || scan_number(q, end, number)) return false;
  const char* rows = skip_to_row(next, end);
  const Row row = rows == end ? Row{} : scan_row(rows, end);
  if (row.columns < 3 || how == Titles::likely) return row.columns >= 3;
  if (row.wrong) return false;
  std::size_t words = 1;
  const char separator = line.find(';') != line.npos ? ';' : line.find(',') != line.npos ? ',' : ' ';
  for (std::size_t i = 1; i < line.size(); ++i)
    words += separator == ' ' ? !is_blank(line[i]) && is_blank(line[i - 1]) : line[i] == separator;
  return words == row.columns;
}

/// Moves behind a line of titles; false if there is none.
bool skip_title(const char*& p, const char* end, Titles how) {
  if (p == end || !is_title(p, end, how)) return false;
  p = skip_to_row(next_line(p, end), end);
  return true;
}

void remark_title(const Source& source, const char* at) {
  const char* end = next_line(at, source.end());
  while (end > at && (is_blank(end[-1]) || end[-1] == '\n')) --end;
  remark(source, make_finding(FindingCode::line_skipped,
                              {{"name", std::string(source.name)},
                               {"line", static_cast<double>(1 + std::count(source.begin(), at, '\n'))},
                               {"text", quoted({at, static_cast<std::size_t>(end - at)})}}));
}

Layout find_layout(const Source& source) {
  Layout layout;
  layout.begin = skip_to_row(source.begin(), source.end());
  if (const char* title = layout.begin; skip_title(layout.begin, source.end(), Titles::likely))
    remark_title(source, title);
  layout.count = count_of(layout.begin, source.end());
  if (layout.count) layout.begin = skip_to_row(next_line(layout.begin, source.end()), source.end());
  if (layout.begin == source.end()) fail(source, "holds no points; export the file again");
  const char* p = layout.begin;
  const Row first = scan_row(p, source.end());
  require_numbers(source, first, layout.begin);
  if (first.columns < 3) {
    fail_at(source, layout.begin,
            fmt::format("a point needs three coordinates, this line holds {} number{}; correct it or export the file "
                        "again",
                        first.columns, first.columns == 1 ? "" : "s"));
  }
  layout.columns = first.columns;
  return layout;
}

std::vector<Piece> cut(const Layout& layout, const char* end) {
  std::vector<Piece> pieces;
  for (const char* at = layout.begin; at < end; at = pieces.back().end) {
    pieces.emplace_back();
    pieces.back().begin = at;
    pieces.back().end = static_cast<std::size_t>(end - at) <= piece_size ? end : next_line(at + piece_size, end);
  }
  return pieces;
}

void read_piece(const Source& source, const Layout& layout, Piece& piece) {
  for (const char* p = skip_to_row(piece.begin, piece.end); p < piece.end; p = skip_to_row(p, piece.end)) {
    const char* begin = p;
    const Row row = scan_row(p, piece.end);
    if (row.wrong || row.mixed[0] != row.mixed[1]) require_numbers(source, row, begin);
    if (row.columns != layout.columns) {
      fail_at(source, begin,
              fmt::format("has {} columns, but the first point has {}; {}", row.columns, layout.columns,
                          p == source.end() ? "the file is truncated" : "correct it or export the file again"));
    }
    piece.points.push_back(row.triple(0));
    if (layout.columns >= 6) piece.triples[0].push_back(row.triple(3));
    if (layout.columns >= 9) piece.triples[1].push_back(row.triple(6));
    p = next_line(p, piece.end);  // a comment may end the row
  }
}

/// What to take of each piece, one behind the other.
template <typename Member>
std::vector<Vec3> join(const Source& source, std::vector<Piece>& pieces, const Member& member) {
  if (pieces.size() == 1) return std::move(member(pieces[0]));
  std::vector<std::size_t> first(pieces.size() + 1);
  for (std::size_t i = 0; i < pieces.size(); ++i) first[i + 1] = first[i] + member(pieces[i]).size();
  std::vector<Vec3> all(first.back());
  parallel_tasks(*source.context, pieces.size(), [&](std::size_t i) {
    std::copy(member(pieces[i]).begin(), member(pieces[i]).end(), all.data() + first[i]);
    member(pieces[i]) = {};
  });
  return all;
}

/// Colours and other figures stand in the same columns as normals do, but they do not have unit length.
bool are_normals(const std::vector<Piece>& pieces, std::size_t triple) {
  std::size_t unit = 0, other = 0;
  for (const Piece& piece : pieces) {
    for (const Vec3& n : piece.triples[triple]) {
      const double length = norm(n);
      if (length > 0.9 && length < 1.1) {
        ++unit;
      } else if (length != 0 && is_finite(n)) {
        ++other;
      }
    }
  }
  return unit > 0 && other <= unit / 99;
}

bool is_pwn(std::string_view name) {
  return name.size() >= 4 && equals_ignoring_case(name.substr(name.size() - 4), ".pwn");
}

/// Points without what the columns beside them say.
PointCloud cloud_of_rows(const Source& source, const Layout& layout, std::vector<Piece>& pieces) {
  PointCloud cloud;
  const bool always = layout.columns == 6 && is_pwn(source.name);
  for (std::size_t triple = 0; triple < 2 && cloud.normals.empty(); ++triple) {
    if ((always && triple == 0) || are_normals(pieces, triple)) {
      cloud.normals = join(
          source, pieces, [&](Piece & p) -> auto& { return p.triples[triple]; });
    }
  }
  cloud.points = join(
      source, pieces, [](Piece & p) -> auto& { return p.points; });
  return cloud;
}

/// Compares the number of points with the one announced; lines may be twice as many, then the second half are normals.
void settle_count(const Source& source, const Layout& layout, PointCloud& cloud) {
  const std::uint64_t count = *layout.count, rows = cloud.points.size();
  if (rows == count) {
    if (layout.columns > 3 || !is_pwn(source.name)) return;
    fail(source, fmt::format("holds {} points, but their normals do not follow; the file is truncated", count));
  }
  if (rows < count) {
    fail(source, fmt::format("announces {} points, but only {} follow; the file is truncated", count, rows));
  }
  if (layout.columns != 3 || rows != 2 * count) {
    fail(source, fmt::format("announces {} points, but {} lines follow; correct the number or export the file again",
                             count, rows));
  }
  const auto half = cloud.points.begin() + static_cast<std::ptrdiff_t>(count);
  cloud.normals.assign(half, cloud.points.end());
  cloud.points.resize(count);
}

}  // namespace

bool is_point_name(std::string_view name) {
  if (name.size() < 4) return false;
  const std::string_view ending = name.substr(name.size() - 4);
  return equals_ignoring_case(ending, ".xyz") || equals_ignoring_case(ending, ".pts") ||
         equals_ignoring_case(ending, ".csv") || is_pwn(name);
}

bool is_point_text(std::string_view bytes) {
  bytes = bytes.substr(0, 1 << 16);
  const char* end = bytes.data() + bytes.size();
  const char* p = skip_to_row(bytes.data(), end);
  skip_title(p, end, Titles::surely);
  if (count_of(p, end)) p = skip_to_row(next_line(p, end), end);
  if (p == end) return false;
  const Row row = scan_row(p, end);
  return row.columns >= 3 && !row.wrong;
}

PointCloud read_point_text(const Source& original) {
  std::string storage;
  const Source source = original.with(with_unix_lines(original.bytes, storage));
  const Layout layout = find_layout(source);
  std::vector<Piece> pieces = cut(layout, source.end());
  parallel_tasks(*source.context, pieces.size(), [&](std::size_t i) {
    try {
      read_piece(source, layout, pieces[i]);
    } catch (const UnusableInput&) {
      pieces[i].error = std::current_exception();  // the first in the file is told, whichever thread was first
    }
  });
  std::uint64_t total = 0;
  for (const Piece& piece : pieces) {
    if (piece.error) std::rethrow_exception(piece.error);
    total += piece.points.size();
  }
  if (total > max_vertices) fail(source, "has more than 4,294,967,295 points; split it");
  PointCloud cloud = cloud_of_rows(source, layout, pieces);
  if (layout.count) settle_count(source, layout, cloud);
  return cloud;
}

}  // namespace evenmesh
