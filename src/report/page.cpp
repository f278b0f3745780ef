#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>

#include "core/probe_curve.hpp"
#include "io/json.hpp"
#include "report/breakage.hpp"
#include "report/bundle.hpp"
#include "report/film.hpp"
#include "report/findings.hpp"
#include "report/packed_bytes.hpp"

namespace breccia::report {
namespace {

constexpr std::size_t most_rows = 4000;

/// JSON inside HTML: nothing in it may end the element that holds it.
std::string script_safe(std::string text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

std::string dumped(const Json& json) {
  return json_text(json);
}

/// A vector; what has no bound becomes null.
Json vector_json(const Vec3& v) {
  return {v.x, v.y, v.z};
}

/// Gathers what the page carries.
class Writer {
 public:
  std::string run(const Record& record, std::size_t limit) {
    Json json;
    const std::string title = record.scene.title;
    json["name"] = record.text("case.name");
    json["title"] = title.empty() ? record.text("case.name") : title;
    json["folder"] = std::filesystem::path(record.folder).lexically_normal().filename().string();
    json["why"] = findings_of(record);
    json["warnings"] = record.warnings;
    json["color"] = record.scene.color;
    json["view"] = record.scene.view;
    if (!record.scene.curves.empty())
      if (const auto curve = ProbeCurve::parsed(record.scene.curves.front()))
        json["curve"] = {{"x", curve->x.probe}, {"y", curve->y.probe}};
    json["bar_radius"] = record.scene.bar_radius;
    json["walls"] = Json::array();
    for (const Wall& wall : record.scene.walls)
      json["walls"].push_back({{"name", wall.name},
                               {"point", vector_json(wall.point)},
                               {"normal", vector_json(wall.normal)},
                               {"velocity", vector_json(wall.velocity)}});
    json["regions"] = Json::array();
    for (const Region& region : record.scene.regions)
      json["regions"].push_back({{"name", region.name},
                                 {"low", vector_json(region.low)},
                                 {"high", vector_json(region.high)},
                                 {"load", region.load}});
    std::vector<std::string> notes;
    json["history"] = table(record.history, "history.csv", notes);
    json["cracks"] = table(record.cracks, "cracks.csv", notes);
    if (!record.case_text.empty()) json["case"] = add_blob(record.case_text);
    std::string film = "null";
    if (!record.times.empty()) film = add_film(record, limit, json, notes);
    json["notes"] = notes;
    for (const std::string& note : notes) notes_.push_back(note);
    std::string text = dumped(json);
    text.pop_back();
    return text + ",\"summary\":" + record.summary + ",\"film\":" + film + "}";
  }

  const std::vector<std::string>& blobs() const { return blobs_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::size_t add_blob(const std::string& bytes) {
    blobs_.push_back(base64(deflated(bytes)));
    return blobs_.size() - 1;
  }

  /// Columns as Float32, bytes in planes.
  Json table(const NumberTable& table, const char* name, std::vector<std::string>& notes) {
    if (table.columns.empty()) return nullptr;
    const std::size_t rows = table.rows(), stride = (rows + most_rows - 1) / most_rows;
    if (stride > 1)
      notes.push_back(fmt::format("One in {} of the {} rows of {} is here.", stride, rows, name));
    Json json{{"columns", Json::array()}};
    Planes planes;
    std::size_t kept = 0;
    for (const Column& column : table.columns) {
      json["columns"].push_back({{"name", column.name}, {"unit", column.unit}});
      std::vector<std::uint32_t> bits;
      for (std::size_t i = 0; i < rows; ++i)
        if (i % std::max<std::size_t>(stride, 1) == 0 || i + 1 == rows)
          bits.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(column.values[i])));
      planes.add(bits, 4);
      kept = bits.size();
    }
    json["rows"] = kept;
    json["blob"] = add_blob(planes.bytes());
    return json;
  }

  std::string add_film(const Record& record, std::size_t limit, Json& json,
                       std::vector<std::string>& notes) {
    const Survey survey = survey_of(record.folder, record.times.size());
    json["roses"] = Json::array();
    for (const Rose& rose : roses_of(record, survey.first, survey.last))
      json["roses"].push_back({{"name", rose.name},
                               {"from", rose.from},
                               {"to", rose.to},
                               {"unit", rose.unit},
                               {"bars", rose.bars}});
    json["fragments"] = fragment_shares(record, survey.last);
    json["events"] = events(record, survey);
    const Film film = film_of(record.folder, survey, blobs_.size(), limit);
    blobs_.insert(blobs_.end(), film.blobs.begin(), film.blobs.end());
    notes.insert(notes.end(), film.notes.begin(), film.notes.end());
    return film.json;
  }

  /// Broken links by kind over time: at rows of the history where the run tells, else at frames.
  static Json events(const Record& record, const Survey& survey) {
    Json json = Json::array();
    const auto add = [&](double time, const std::vector<std::size_t>& broken) {
      json.push_back({{"time", time}, {"broken", broken}});
    };
    const std::vector<Break>& breaks = record.breaks;
    if (breaks.empty() || !record.cracks.columns.empty()) {
      for (const FrameFacts& frame : survey.frames) add(frame.time, frame.broken);
      return json;
    }
    std::size_t kinds = 0;
    for (const Break& b : breaks) kinds = std::max(kinds, b.kind + 1);
    std::vector<std::size_t> broken(kinds, 0);
    const double end = std::max(record.times.back(), breaks.back().time);
    const double apart = end / 1000.0;  // of points of the curve, at least
    double last = 0.0;
    add(last, broken);
    for (std::size_t i = 0; i < breaks.size(); ++i) {
      const double time = breaks[i].time;
      if (time > last + 2.0 * apart) add(last = time - apart, broken);  // level until then
      ++broken[breaks[i].kind];
      const bool row_ends = i + 1 == breaks.size() || breaks[i + 1].time > time;
      if (row_ends && time >= last + apart) add(last = time, broken);
    }
    add(end, broken);
    return json;
  }

  std::vector<std::string> blobs_, notes_;
};

Json measured_json(const Measured& measured) {
  Json json{{"name", measured.name}, {"columns", Json::array()}};
  for (const Column& column : measured.table.columns)
    json["columns"].push_back(
        {{"name", column.name}, {"unit", column.unit}, {"values", column.values}});
  return json;
}

/// The template with its places filled, each once.
std::string filled(std::string_view form,
                   const std::vector<std::pair<std::string_view, std::string_view>>& contents) {
  std::string html;
  std::size_t begin = 0;
  while (begin < form.size()) {
    std::size_t next = form.size();
    const std::pair<std::string_view, std::string_view>* place = nullptr;
    for (const auto& content : contents) {
      const std::size_t found = form.find(content.first, begin);
      if (found >= next) continue;
      next = found;
      place = &content;
    }
    html += form.substr(begin, next - begin);
    if (place == nullptr) break;
    html += place->second;
    begin = next + place->first.size();
  }
  return html;
}

}  // namespace

std::string escaped_html(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

namespace {

/// @param live  JSON for a page that keeps up with a run; empty: the page asks nobody
Page written(const std::vector<Record>& runs, const std::optional<Measured>& measured,
             std::size_t limit, const std::string& live) {
  Writer writer;
  std::string data = "{\"runs\":[";
  for (std::size_t r = 0; r < runs.size(); ++r)
    data += (r == 0 ? "" : ",") + writer.run(runs[r], limit / runs.size());
  data += "]";
  if (measured) data += ",\"measured\":" + dumped(measured_json(*measured));
  if (!live.empty()) data += ",\"live\":" + live;
  data += "}";
  std::string blobs;
  for (std::size_t b = 0; b < writer.blobs().size(); ++b)
    blobs += fmt::format("<script type=\"application/octet-stream\" id=\"blob-{}\">{}</script>\n",
                         b, writer.blobs()[b]);
  std::string title;
  for (const Record& run : runs) title += (title.empty() ? "" : " and ") + run.text("case.name");
  const std::string safe_title = escaped_html(title), safe_data = script_safe(std::move(data));
  return {filled(page_template(), {{"@TITLE@", safe_title},
                                   {"@CONNECT@", live.empty() ? "" : "; connect-src 'self'"},
                                   {"@STYLE@", page_style()},
                                   {"@DATA@", safe_data},
                                   {"@BLOBS@", blobs},
                                   {"@PROGRAM@", page_program()}}),
          writer.notes()};
}

}  // namespace

Page page_of(const std::vector<Record>& runs, const std::optional<Measured>& measured,
             std::size_t limit) {
  return written(runs, measured, limit, "");
}

Page live_page_of(const Record& run, const std::string& state) {
  return written({run}, std::nullopt, page_bytes, state);
}

}  // namespace breccia::report
