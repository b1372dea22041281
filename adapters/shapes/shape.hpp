/// One list of fields per struct, by which documents are written and read.
#pragma once

#include <boost/preprocessor/control/iif.hpp>
#include <boost/preprocessor/punctuation/is_begin_parens.hpp>
#include <boost/preprocessor/seq/enum.hpp>
#include <boost/preprocessor/seq/transform.hpp>
#include <boost/preprocessor/stringize.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>
#include <tuple>
#include <type_traits>

namespace recald::shapes {

/// A member and its name in documents.
template <class Struct, class Value>
struct Field {
  constexpr Field(const char* written, Value Struct::*member) : name(written), value(member) {}

  const char* name;
  Value Struct::*value;
};

/// Of a struct that is listed: a tuple of its fields, in the order in which people read them.
template <class Struct>
inline constexpr auto fields = nullptr;

template <class Struct>
concept Listed = requires {
  std::tuple_size<std::remove_cvref_t<decltype(fields<Struct>)>>::value;
};

}  // namespace recald::shapes

/// `SHAPE(Progress, entries, events, (result, "document"))`, once for a struct, in no namespace:
/// its members, which are called the same in documents unless another name is given.
#define SHAPE(Struct, ...)                                                                  \
  template <>                                                                               \
  inline constexpr auto recald::shapes::fields<Struct> = std::make_tuple(BOOST_PP_SEQ_ENUM( \
      BOOST_PP_SEQ_TRANSFORM(RECALD_FIELD, Struct, BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__))))

#define RECALD_FIELD(round, Struct, member)                                              \
  BOOST_PP_IIF(BOOST_PP_IS_BEGIN_PARENS(member), RECALD_NAMED_FIELD, RECALD_PLAIN_FIELD) \
  (Struct, member)
#define RECALD_PLAIN_FIELD(Struct, member) \
  recald::shapes::Field(BOOST_PP_STRINGIZE(member), &Struct::member)
#define RECALD_NAMED_FIELD(Struct, member) RECALD_NAMED_AS(Struct, RECALD_BOTH member)
#define RECALD_BOTH(member, name) member, name
#define RECALD_NAMED_AS(...) RECALD_NAMED_OF(__VA_ARGS__)
#define RECALD_NAMED_OF(Struct, member, name) recald::shapes::Field(name, &Struct::member)
