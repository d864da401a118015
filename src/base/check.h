#ifndef VERDURE_BASE_CHECK_H_
#define VERDURE_BASE_CHECK_H_

#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace verdure {

template <class A, class B>
[[noreturn]] void checkFailed(const char* file, int line, const char* text, const A& a,
                              const B& b) {
  std::ostringstream out;
  out << file << ':' << line << ": broken invariant: " << text << " (" << a << " against " << b
      << ")\n";
  std::fputs(out.str().c_str(), stderr);
  std::abort();
}

}  // namespace verdure

/// A broken invariant of the library: prints both values and aborts. Never for bad input.
#define VERDURE_CHECK_OP(a, op, b) \
  ((a)op(b) ? void() : ::verdure::checkFailed(__FILE__, __LINE__, #a " " #op " " #b, (a), (b)))
#define VERDURE_CHECK_EQ(a, b) VERDURE_CHECK_OP(a, ==, b)
#define VERDURE_CHECK_LT(a, b) VERDURE_CHECK_OP(a, <, b)

#endif  // VERDURE_BASE_CHECK_H_
