#include "run/frames/frame_parts.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "exec/tasks.hpp"
#include "io/picture/stress_measures.hpp"
#include "io/vtu/touching.hpp"

namespace breccia {
namespace {

/// work(width), with the usual widths of items as constants.  [bytes]
template <class Work>
void with_width(std::size_t width, const Work& work) {
  switch (width) {
    case 4:
      return work(std::integral_constant<std::size_t, 4>{});
    case 8:
      return work(std::integral_constant<std::size_t, 8>{});
    case 12:
      return work(std::integral_constant<std::size_t, 12>{});
    case 16:
      return work(std::integral_constant<std::size_t, 16>{});
    case 24:
      return work(std::integral_constant<std::size_t, 24>{});
    default:
      return work(width);
  }
}

/// Which rank compresses which block: shares of about equal cost. Rank 0 draws the picture, too.
std::vector<int> workers(const FrameBlocks& files, int ranks, const FrameWish& wish) {
  std::vector<std::size_t> cost(static_cast<std::size_t>(ranks), 0);
  // A pixel takes as long as some fifteen bytes of a block.
  if (wish.picture)
    cost[0] = 15 * static_cast<std::size_t>(wish.picture->width) *
              static_cast<std::size_t>(wish.picture->height > 0 ? wish.picture->height
                                                                : wish.picture->width * 3 / 4);
  std::vector<int> worker;
  for (const FrameBlocks::Block& block : files.blocks()) {
    const auto idlest = std::min_element(cost.begin(), cost.end());
    // Bytes that are all alike are packed in no time.
    *idlest += files.array_of(block).width == 1 ? block.size / 8 : block.size;
    worker.push_back(static_cast<int>(idlest - cost.begin()));
  }
  return worker;
}

/// Items of a frame that show in a picture by a field, as columns of a part and of the whole.
class Sight {
 public:
  /// @param whole  gets as many items as there are in all; null on ranks other than 0
  Sight(const FramePart& part, const RenderOptions& options, Frame* whole)
      : places_(part.places), options_(options), whole_(whole) {
    const Frame& f = part.frame;
    if (may_show_contacts(options)) contacts_ = &f.contacts;
    column(Carrier::points, f.position, whole ? &whole->position : nullptr, 1);
    if (places_.has_spheres) column(Carrier::points, f.radius, whole ? &whole->radius : nullptr, 1);
    if (places_.triangles > 0)
      column(Carrier::triangles, f.triangles, whole ? &whole->triangles : nullptr, 3);
    if (places_.tetrahedra > 0)
      column(Carrier::tetrahedra, f.tetrahedra, whole ? &whole->tetrahedra : nullptr, 4);
    fields(Carrier::points, f.point_fields, whole ? &whole->point_fields : nullptr);
    fields(Carrier::triangles, f.triangle_fields, whole ? &whole->triangle_fields : nullptr,
           places_.tetrahedra > 0);
    fields(Carrier::tetrahedra, f.tetrahedron_fields, whole ? &whole->tetrahedron_fields : nullptr);
    const bool cracks = places_.plane() && has_cracks(f);
    const bool lines = cracks || options.show_links || options.xray;
    if (!lines && !colors_lines(f, options.field)) return;
    column(Carrier::lines, f.lines, whole ? &whole->lines : nullptr, 2);
    fields(Carrier::lines, f.line_fields, whole ? &whole->line_fields : nullptr, cracks);
  }

  Message packed() const {
    Message message;
    put_array(message, places_.point);
    put_array(message, places_.triangle);
    put_array(message, places_.tetrahedron);
    put_array(message, places_.line);
    if (contacts_ != nullptr) put_array(message, *contacts_);
    for (const Column& c : columns_) put_bytes(message, c.own.data(), c.own.size());
    return message;
  }
  /// Rank 0: what another part has.
  void take(const Message& message) const {
    Unpacking from(message);
    FramePlaces places;
    places.point = from.array<std::int32_t>();
    places.triangle = from.array<std::int32_t>();
    places.tetrahedron = from.array<std::int32_t>();
    places.line = from.array<std::int32_t>();
    if (contacts_ != nullptr) {
      const std::vector<FrameContact> own = from.array<FrameContact>();
      whole_->contacts.insert(whole_->contacts.end(), own.begin(), own.end());
    }
    for (const Column& c : columns_) {
      const std::vector<std::int32_t>& to = places.of(c.carrier);
      const std::span<const std::byte> values = from.bytes(to.size() * c.width);
      with_width(c.width, [&](auto width) {
        for (std::size_t i = 0; i < to.size(); ++i)
          std::memcpy(c.whole + static_cast<std::size_t>(to[i]) * width, values.data() + i * width,
                      width);
      });
    }
  }

 private:
  struct Column {
    Carrier carrier;
    std::size_t width;  ///< bytes an item
    std::span<const std::byte> own;
    std::byte* whole;
  };

  template <class T>
  void column(Carrier carrier, const std::vector<T>& own, std::vector<T>* whole,
              std::size_t components) {
    if (whole != nullptr)
      whole->resize(static_cast<std::size_t>(places_.count(carrier)) * components);
    columns_.push_back({carrier, components * sizeof(T), std::as_bytes(std::span(own)),
                        whole ? reinterpret_cast<std::byte*>(whole->data()) : nullptr});
  }
  void fields(Carrier carrier, const std::vector<FrameField>& own, std::vector<FrameField>* whole,
              bool cracks = false) {
    const std::string& shown = options_.field;
    const auto is_shown = [&](const std::string& name) {
      return name == shown || shown.starts_with(name + "_") || name == options_.arrows ||
             ((options_.crosses || is_stress_measure(shown)) && name.starts_with("stress")) ||
             (options_.scale != 1.0 && name == "displacement");
    };
    for (const FrameField& field : own) {
      const bool of_cracks = cracks && (field.name == "mode" || field.name == "damage");
      const bool wanted = of_cracks || is_shown(field.name) || field.name == "group" ||
                          field.name == "bar" || field.name == "kind" || field.name == "state" ||
                          field.name == "held" || field.name == "exposed";
      if (!wanted) continue;
      if (whole != nullptr) whole->push_back({field.name, field.unit, field.components, {}});
      column(carrier, field.values, whole ? &whole->back().values : nullptr,
             static_cast<std::size_t>(field.components));
    }
  }

  const FramePlaces& places_;
  const RenderOptions& options_;
  Frame* whole_;
  const std::vector<FrameContact>* contacts_ = nullptr;  ///< of this part, if they may be shown
  std::vector<Column> columns_;
};

}  // namespace

FrameOfParts::FrameOfParts(FramePart part, const FrameWish& wish, Communicator& ranks, int threads)
    : part_(std::move(part)), wish_(wish), ranks_(ranks), threads_(threads) {
  if (!wish_.files) return;
  files_.emplace(part_.frame, part_.places, wish_.format);
  worker_ = workers(*files_, ranks_.size(), wish_);
}

/// Everything that the picture shows comes to rank 0.
void FrameOfParts::see() {
  const bool draws = ranks_.rank() == 0;
  const Sight sight(part_, *wish_.picture, draws ? &seen_ : nullptr);
  const std::vector<Message> messages = told_to_first(ranks_, sight.packed());
  if (!draws) return;
  seen_.step = part_.frame.step;
  seen_.time = part_.frame.time;
  seen_.groups = part_.frame.groups;
  seen_.walls = part_.frame.walls;
  seen_.bolted = part_.frame.bolted;
  seen_.bars = part_.frame.bars;
  for (const Message& message : messages) sight.take(message);
}

/// This part's share of a block: how many items, where each stands behind the first, values.
void FrameOfParts::give_values(Message& message, const Block& block) const {
  const FrameBlocks::Array& array = files_->array_of(block);
  const std::vector<std::int32_t>& places = part_.places.of(array.carrier);
  const auto first = static_cast<std::int32_t>(block.begin / array.width);
  const auto end =
      static_cast<std::int32_t>((block.begin + block.size + array.width - 1) / array.width);
  const auto from = std::lower_bound(places.begin(), places.end(), first);
  const auto to = std::lower_bound(from, places.end(), end);
  std::vector<std::uint16_t> behind;  // a block has no more items than it can count
  behind.reserve(static_cast<std::size_t>(to - from));
  for (auto place = from; place != to; ++place)
    behind.push_back(static_cast<std::uint16_t>(*place - first));
  put_array(message, behind);
  put_bytes(message,
            array.own.data() + static_cast<std::size_t>(from - places.begin()) * array.width,
            behind.size() * array.width);
}

/// The block, from what all ranks have of it.
void FrameOfParts::take_values(const Block& block, const std::vector<Values>& from,
                               std::vector<std::byte>& to) const {
  const std::size_t end = block.begin + block.size;
  to.resize(block.size);
  with_width(files_->array_of(block).width, [&](auto width) {
    const std::size_t first = block.begin / width * width;
    for (const Values& values : from)
      for (std::size_t i = 0; i < values.behind.size(); ++i) {
        const std::size_t begin = first + values.behind[i] * width;
        const std::byte* const item = values.bytes.data() + i * width;
        if (begin >= block.begin && begin + width <= end) {
          std::memcpy(to.data() + (begin - block.begin), item, width);
          continue;
        }
        // It lies across the border of two blocks.
        const std::size_t low = std::max(begin, block.begin);
        std::memcpy(to.data() + (low - block.begin), item + (low - begin),
                    std::min(begin + width, end) - low);
      }
  });
}

Message FrameOfParts::share() {
  if (wish_.picture) see();
  const auto self = static_cast<std::size_t>(ranks_.rank());
  std::vector<std::size_t> own;
  std::vector<Message> messages(static_cast<std::size_t>(ranks_.size()));
  for (std::size_t b = 0; b < worker_.size(); ++b) {
    const Block& block = files_->blocks()[b];
    const auto worker = static_cast<std::size_t>(worker_[b]);
    if (worker == self) own.push_back(b);
    if (files_->array_of(block).carrier != Carrier::none) give_values(messages[worker], block);
  }
  messages = ranks_.exchange(std::move(messages));

  std::vector<Unpacking> from(messages.begin(), messages.end());
  std::vector<std::vector<Values>> values(own.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    const FrameBlocks::Array& array = files_->array_of(files_->blocks()[own[k]]);
    if (array.carrier == Carrier::none) continue;
    for (Unpacking& message : from) {
      Values& part = values[k].emplace_back();
      part.behind = message.array<std::uint16_t>();
      part.bytes = message.bytes(part.behind.size() * array.width);
    }
  }

  Image image;
  if (wish_.picture && self == 0) image = drawn(seen_, wish_, threads_, output_);
  std::vector<std::string> packed(own.size());
  for_each_task(threads_, 1 + static_cast<int>(own.size()), [&](int task) {
    const std::size_t k = static_cast<std::size_t>(task) - 1;
    if (task == 0) {
      if (image.width > 0) output_.png = png_content(image);
      return;
    }
    const Block& block = files_->blocks()[own[k]];
    std::vector<std::byte> bytes;
    if (files_->array_of(block).carrier == Carrier::none) {
      packed[k] = files_->packed(block);
    } else {
      take_values(block, values[k], bytes);
      packed[k] = files_->packed(block, bytes);
    }
  });

  Message share;
  for (const std::string& block : packed) {
    put_value(share, block.size());
    put_bytes(share, block.data(), block.size());
  }
  if (files_) {
    Around around;
    around.add(part_.frame.position);
    put_value(share, around);
    put_array(share, part_.frame.contacts);
  }
  return share;
}

FrameOutput FrameOfParts::output() {
  const std::vector<Message> shares = told_to_first(ranks_, share());
  if (shares.empty()) return {};
  std::vector<Unpacking> from(shares.begin(), shares.end());
  std::vector<std::string> packed;
  packed.reserve(worker_.size());
  for (const int worker : worker_) {
    Unpacking& share = from[static_cast<std::size_t>(worker)];
    const std::span<const std::byte> block = share.bytes(share.value<std::size_t>());
    packed.emplace_back(reinterpret_cast<const char*>(block.data()), block.size());
  }
  if (!files_) return std::move(output_);
  output_.files = files_->contents(packed);
  Touching touching;
  touching.plane = part_.places.plane();
  for (Unpacking& share : from) {
    touching.around.add(share.value<Around>());
    const std::vector<FrameContact> own = share.array<FrameContact>();
    touching.contacts.insert(touching.contacts.end(), own.begin(), own.end());
  }
  add_touching(output_.files, part_.frame, std::move(touching), wish_.format, threads_);
  return std::move(output_);
}

}  // namespace breccia
