#include "io/vtu/paraview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "exec/error.hpp"
#include "io/frame_pair.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"

namespace breccia {
namespace {

/// Opens a folder with spheres as spheres, coloured, at the first look.
constexpr const char* script = R"(# paraview open_in_paraview.py
import os
from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__))
view = GetActiveViewOrCreate("RenderView")
elements = OpenDataFile(os.path.join(here, "elements.LIST"))
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()
points = elements.PointData
shown = Show(elements, view)
if points.GetArray("radius"):
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Sphere"
    shown.ScaleByArray = 1
    shown.SetScaleArray = ["POINTS", "radius"]
    shown.UseScaleFunction = 0
    shown.GaussianRadius = 1.0
where = "POINTS" if points.GetArray("damage") else "CELLS"
ColorBy(shown, (where, "damage"))
GetColorTransferFunction("damage").RescaleTransferFunction(0.0, 1.0)
shown.SetScalarBarVisibility(view, True)
RenameSource("elements", elements)
for kind in ("links", "contacts", "walls", "bolts", "tetrahedra", "joints", "joint_contacts"):
    path = os.path.join(here, kind + ".LIST")
    if not os.path.exists(path):
        continue
    more = OpenDataFile(path)
    RenameSource(kind, more)
    if kind == "walls":
        Show(more, view).Opacity = 0.3
    elif kind in ("tetrahedra", "bolts"):
        Show(more, view)
    else:
        Hide(more, view)
bounds = elements.GetDataInformation().GetBounds()
if bounds[5] > bounds[4]:
    view.CameraPosition, view.CameraViewUp = [-1.0, -2.0, 1.2], [0.0, 0.0, 1.0]
    view.CameraFocalPoint = [0.0, 0.0, 0.0]
ResetCamera(view)
Render(view)
)";

}  // namespace

std::string ParaviewSeries::file_of(const std::string& kind, std::size_t frame) const {
  return fmt::format("fields/{}_{:04}.{}", kind, frame,
                     format_ == FrameFormat::vtu ? "vtu" : "hdf");
}

/// ParaView's collection of files with times; several kinds become parts of one data set.
std::string ParaviewSeries::collection(std::span<const std::string> parts) const {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t frame = 0; frame < times_.size(); ++frame) {
    for (std::size_t part = 0; part < parts.size(); ++part) {
      text += fmt::format(R"(<DataSet timestep="{}" group="" part="{}" name="{}" file="{}"/>)",
                          times_[frame], part, parts[part], file_of(parts[part], frame));
      text += "\n";
    }
  }
  return text + "</Collection>\n</VTKFile>\n";
}

/// ParaView's list of other files with times, as JSON.
std::string ParaviewSeries::series(const std::string& kind) const {
  std::string text = "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [";
  for (std::size_t frame = 0; frame < times_.size(); ++frame)
    text += fmt::format("{}\n    {{\"name\": \"{}\", \"time\": {}}}", frame == 0 ? "" : ",",
                        file_of(kind, frame), times_[frame]);
  return text + "\n  ]\n}\n";
}

ParaviewSeries::ParaviewSeries(const std::string& folder, FrameFormat format)
    : folder_(folder), format_(format) {
  std::error_code error;
  std::filesystem::create_directories(folder_ + "/fields", error);
  if (error) throw IoError(folder_ + "/fields: cannot make the folder: " + error.message());
}

ParaviewSeries ParaviewSeries::resumed(const std::string& folder, double time, FrameFormat format) {
  ParaviewSeries series(folder, format);
  if (!holds_frames(folder)) return series;
  series.times_ = frame_times(folder);
  for (const char* kind :
       {"contacts", "walls", "bolts", frame_of_solids, joints_of_solids, contacts_of_solids})
    if (std::filesystem::exists(folder + "/" + series.file_of(kind, 0)))
      series.kinds_.emplace_back(kind);
  series.listed_ = series.times_.size();
  const auto later = std::upper_bound(series.times_.begin(), series.times_.end(), time);
  series.drop_from(static_cast<std::size_t>(later - series.times_.begin()));
  return series;
}

void ParaviewSeries::write(const FrameContents& frame) {
  const auto same = std::lower_bound(times_.begin(), times_.end(), frame.time);
  drop_from(static_cast<std::size_t>(same - times_.begin()));
  const std::string start = folder_ + "/";
  const auto add = [&](const std::string& kind, const std::string& content) {
    if (content.empty()) return;
    replace_file(start + file_of(kind, times_.size()), content);
    if (std::find(kinds_.begin(), kinds_.end(), kind) == kinds_.end()) kinds_.emplace_back(kind);
  };
  add("elements", frame.points);
  add("links", frame.lines);
  add("contacts", frame.contacts);
  add("walls", frame.walls);
  add("bolts", frame.bolts);
  for (const auto& [kind, content] : frame.more) add(kind, content);
  times_.push_back(frame.time);
  if (collections_are_due()) write_collections();
}

void ParaviewSeries::finish() {
  if (listed_ != times_.size()) write_collections();
}

bool ParaviewSeries::collections_are_due() const {
  constexpr std::size_t few = 256;
  constexpr int share = 20;
  return times_.size() <= few || Clock::now() - listed_at_ >= share * listing_;
}

void ParaviewSeries::write_collections() {
  const Clock::time_point begin = Clock::now();
  const bool xml = format_ == FrameFormat::vtu;
  std::string opens = script;
  for (std::size_t place = 0; (place = opens.find("LIST")) != std::string::npos;)
    opens.replace(place, 4, xml ? "pvd" : "hdf.series");
  replace_file(folder_ + "/open_in_paraview.py", opens);
  if (xml) {
    for (const std::string& kind : kinds_)
      replace_file(folder_ + "/" + kind + ".pvd", collection(std::span(&kind, 1)));
    replace_file(folder_ + "/result.pvd", collection(kinds_));
  } else {
    for (const std::string& kind : kinds_)
      replace_file(folder_ + "/" + kind + ".hdf.series", series(kind));
  }
  listed_ = times_.size();
  listed_at_ = Clock::now();
  listing_ = listed_at_ - begin;
}

void ParaviewSeries::drop_from(std::size_t first) {
  if (first >= times_.size()) return;
  const std::size_t count = times_.size();
  times_.resize(first);
  write_collections();  // before the files go: at no moment does a collection name a missing file
  for (std::size_t frame = first; frame < count; ++frame) {
    for (const std::string& kind : kinds_) {
      std::error_code ignored;  // a file that stays behind harms nobody
      std::filesystem::remove(folder_ + "/" + file_of(kind, frame), ignored);
    }
  }
}

}  // namespace breccia
