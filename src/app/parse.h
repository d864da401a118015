#ifndef VERDURE_APP_PARSE_H_
#define VERDURE_APP_PARSE_H_

#include <string>
#include <utility>
#include <vector>

namespace verdure::app {

/// Comma-separated numbers; throws Error, naming `option`, unless there are `count` (0: any).
std::vector<float> parseNumbers(const std::string& option, const std::string& text,
                                std::size_t count);

/// "960x720" to two numbers. Throws Error that names --size.
std::pair<int, int> parseSize(const std::string& text);

}  // namespace verdure::app

#endif  // VERDURE_APP_PARSE_H_
