#pragma once
// Case files of all methods. What reads, completes and lists their keys is instantiated once, in
// case_keys.cpp, and not again by each file that asks for it.

#include <string>
#include <vector>

#include "coupled/setup/config.hpp"
#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "io/case/case_file.hpp"

// clang-format off
#define BR_CASE_KEYS(EXTERN, CONFIG)                                                             \
  EXTERN template CONFIG read_case<CONFIG>(const std::string&, const std::vector<std::string>&); \
  EXTERN template CONFIG read_case<CONFIG>(const CaseText&, const std::vector<std::string>&);    \
  EXTERN template std::string completed_case<CONFIG>(const CONFIG&);                             \
  EXTERN template std::vector<KeyInfo> list_keys<CONFIG>(const std::string&);
#define BR_ALL_CASE_KEYS(EXTERN)       \
  BR_CASE_KEYS(EXTERN, dem::Config)    \
  BR_CASE_KEYS(EXTERN, fdem::Config)   \
  BR_CASE_KEYS(EXTERN, fdem3::Config)  \
  BR_CASE_KEYS(EXTERN, coupled::Config)
// clang-format on

namespace breccia {

BR_ALL_CASE_KEYS(extern)

}  // namespace breccia
