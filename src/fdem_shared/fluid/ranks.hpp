#pragma once
// State of fluids and bolts that ranks take over from rank 0.

#include "domain/together.hpp"
#include "exec/buffer.hpp"

namespace breccia::fdem_shared {

/// The items of an array that all ranks have with one length, as rank 0 has them.
template <class Item>
void take_items(Communicator& ranks, Buffer<Item>& items) {
  Message message;
  put_bytes(message, reinterpret_cast<const std::uint8_t*>(items.data()),
            at(items.size()) * sizeof(Item));
  message = ranks.from_first(std::move(message));
  __builtin_memcpy(items.data(), message.data(), message.size());
}

template <class Case, class State>
void take_fluid(Communicator& ranks, const Case& given, State& fluid) {
  take_from_first(ranks, fluid.time);
  if (!given.flow.on) return;
  take_from_first(ranks, fluid.injected);
  take_from_first(ranks, fluid.released);
  take_from_first(ranks, fluid.pressure);
  BR_ASSERT(fluid.volume.size() > 0);
  take_items(ranks, fluid.volume);
}

/// @param gas  empty where a case has none
template <class Source>
void take_gas(Communicator& ranks, Buffer<Source>& gas) {
  if (gas.size() > 0) take_items(ranks, gas);
}

template <class Case, class State>
void take_bolts(Communicator& ranks, const Case& given, State& bolts) {
  if (given.bolts.empty()) return;
  take_from_first(ranks, bolts.time);
  take_items(ranks, bolts.nodes);
}

}  // namespace breccia::fdem_shared
