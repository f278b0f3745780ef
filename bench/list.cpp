#include "bench/list.hpp"

namespace breccia {

const std::vector<Benchmark>& benchmarks() {
  static const std::vector<Benchmark> list{
      {"slab", "steps of the rock on the slab, before and during the impact", measure_slab},
      {"threads", "the slab on one thread and on all, in alternating windows", measure_threads},
      {"search", "the contact search alone, up to a million spheres", measure_search},
      {"burst", "the search when fragments fly far apart", measure_burst},
      {"packing", "disordered packings of a box", measure_packing},
      {"facets", "LDPM: a cube of concrete, whole, pulled apart, crushed", measure_facets},
      {"triangles", "FDEM: plates of 10,000 to a million joined triangles", measure_triangles},
      {"contact", "FDEM: hexagons from far apart to pressed together", measure_contact},
      {"heap", "FDEM: as many hexagons as the moving box, on a GPU a hundred times", measure_heap},
      {"slabs", "many of the paper's slabs, to a million elements, on a GPU to ten", measure_slabs},
      {"roofline", "each kernel on a GPU against the bytes that it moves", measure_roofline},
      {"most_slabs", "62.8 million elements on a GPU", measure_most_slabs},
      {"largest_plate", "FDEM: 50 million joined triangles on a GPU", measure_largest_plate},
      {"slab100k", "the slab with 99,262 elements", measure_large_slab}};
  return list;
}

const std::vector<RankBenchmark>& rank_benchmarks() {
  static const std::vector<RankBenchmark> list{
      {"weak_slabs", "as many of the paper's slabs for each rank", measure_weak_slabs},
      {"strong_slabs", "the same slabs shared by all ranks", measure_strong_slabs},
      {"weak_plate", "FDEM: as many joined triangles for each rank", measure_weak_plate},
      {"set_up", "making a model of spheres and its world, part by part", measure_set_up},
      {"strong_plate", "FDEM: the same triangles shared by all ranks", measure_strong_plate}};
  return list;
}

}  // namespace breccia
