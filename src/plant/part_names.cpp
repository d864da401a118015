#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "plant/classify.h"

namespace verdure {
namespace {

/// Lower case for ASCII, Latin-1 and Cyrillic in UTF-8: the scripts with case in the word lists.
std::string lowered(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x80) {
      out += static_cast<char>(std::tolower(c));
      continue;
    }
    const auto d = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    if (c == 0xc3 && d >= 0x80 && d <= 0x9e && d != 0x97) {  // À..Þ
      out += {static_cast<char>(c), static_cast<char>(d + 0x20)};
    } else if (c == 0xd0 && d >= 0x90 && d <= 0x9f) {  // А..П
      out += {static_cast<char>(c), static_cast<char>(d + 0x20)};
    } else if (c == 0xd0 && d >= 0xa0 && d <= 0xaf) {  // Р..Я
      out += {static_cast<char>(0xd1), static_cast<char>(d - 0x20)};
    } else {
      out += static_cast<char>(c);
      continue;
    }
    ++i;
  }
  return out;
}

/// Words of a name: split at anything that is not a letter, and at "camelCase" humps.
std::vector<std::string> words(const std::string& name) {
  std::vector<std::string> found;
  std::string word;
  const auto flush = [&] {
    if (!word.empty()) found.push_back(lowered(word));
    word.clear();
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool letter = std::isalpha(c) != 0 || c >= 0x80;
    const bool hump =
        i > 0 && std::isupper(c) != 0 && std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
    if (!letter || hump) flush();
    if (letter) word += name[i];
  }
  flush();
  return found;
}

struct Word {
  std::string_view text;
  double score;
};

/// Whole words. Plurals and genders are listed: a rule for them would catch other words.
constexpr std::array kWords = {
    // English
    Word{"leaf", 3}, Word{"leaves", 3}, Word{"leafs", 3}, Word{"leaflet", 3}, Word{"leaflets", 3},
    Word{"lf", 1.5}, Word{"lvs", 2}, Word{"foliage", 3}, Word{"folliage", 3}, Word{"needle", 3},
    Word{"needles", 3}, Word{"flower", 3}, Word{"flowers", 3}, Word{"blossom", 3},
    Word{"blossoms", 3}, Word{"petal", 3}, Word{"petals", 3}, Word{"bloom", 2}, Word{"frond", 3},
    Word{"fronds", 3}, Word{"grass", 2.5}, Word{"blade", 2}, Word{"blades", 2}, Word{"fern", 2},
    Word{"ivy", 2}, Word{"canopy", 2}, Word{"crown", 1.5}, Word{"card", 2}, Word{"cards", 2},
    Word{"billboard", 1.5}, Word{"fruit", 1.5}, Word{"fruits", 1.5}, Word{"berry", 1.5},
    Word{"berries", 1.5}, Word{"catkin", 2}, Word{"greens", 2}, Word{"bark", -4}, Word{"trunk", -4},
    Word{"trunks", -4}, Word{"wood", -3}, Word{"log", -2}, Word{"stump", -3}, Word{"root", -2.5},
    Word{"roots", -2.5}, Word{"branch", -2}, Word{"branches", -2}, Word{"bough", -2},
    Word{"twig", -0.5}, Word{"twigs", -0.5}, Word{"stem", -2.5}, Word{"stems", -2.5},
    Word{"stalk", -2}, Word{"limb", -2}, Word{"limbs", -2}, Word{"cap", -1}, Word{"pot", -3},
    Word{"soil", -3}, Word{"ground", -3},
    // German
    Word{"blatt", 3}, Word{"blätter", 3}, Word{"blaetter", 3}, Word{"laub", 3}, Word{"laubwerk", 3},
    Word{"nadel", 3}, Word{"nadeln", 3}, Word{"blüte", 3}, Word{"blüten", 3}, Word{"bluete", 3},
    Word{"blueten", 3}, Word{"blume", 3}, Word{"blumen", 3}, Word{"wedel", 2}, Word{"gras", 2.5},
    Word{"rinde", -4}, Word{"borke", -4}, Word{"stamm", -4}, Word{"holz", -3}, Word{"ast", -2},
    Word{"äste", -2}, Word{"aeste", -2}, Word{"zweig", -1}, Word{"zweige", -1},
    Word{"stängel", -2.5}, Word{"stiel", -2}, Word{"wurzel", -2.5}, Word{"wurzeln", -2.5},
    // French
    Word{"feuille", 3}, Word{"feuilles", 3}, Word{"feuillage", 3}, Word{"aiguille", 2.5},
    Word{"aiguilles", 2.5}, Word{"fleur", 3}, Word{"fleurs", 3}, Word{"pétale", 3},
    Word{"pétales", 3}, Word{"fronde", 3}, Word{"écorce", -4}, Word{"ecorce", -4},
    Word{"tronc", -4}, Word{"troncs", -4}, Word{"bois", -3}, Word{"branche", -2},
    Word{"tige", -2.5}, Word{"tiges", -2.5}, Word{"racine", -2.5}, Word{"rameau", -1},
    // Spanish, Portuguese, Italian
    Word{"hoja", 3}, Word{"hojas", 3}, Word{"follaje", 3}, Word{"flor", 3}, Word{"flores", 3},
    Word{"aguja", 2.5}, Word{"agujas", 2.5}, Word{"pétalo", 3}, Word{"folha", 3}, Word{"folhas", 3},
    Word{"folhagem", 3}, Word{"foglia", 3}, Word{"foglie", 3}, Word{"fogliame", 3},
    Word{"fiore", 3}, Word{"fiori", 3}, Word{"corteza", -4}, Word{"tronco", -4},
    Word{"troncos", -4}, Word{"madera", -3}, Word{"rama", -2}, Word{"ramas", -2},
    Word{"tallo", -2.5}, Word{"raíz", -2.5}, Word{"casca", -4}, Word{"madeira", -3},
    Word{"galho", -2}, Word{"galhos", -2}, Word{"caule", -2.5}, Word{"corteccia", -4},
    Word{"legno", -3}, Word{"ramo", -2}, Word{"rami", -2}, Word{"fusto", -3}, Word{"radice", -2.5},
    // Dutch, Swedish, Polish
    Word{"blad", 3}, Word{"bladeren", 3}, Word{"löv", 3}, Word{"barr", 2}, Word{"liść", 3},
    Word{"liście", 3}, Word{"liscie", 3}, Word{"schors", -4}, Word{"stam", -3}, Word{"tak", -1},
    Word{"takken", -2}, Word{"pień", -4}, Word{"kora", -4}, Word{"gałąź", -2},
    // Russian
    Word{"лист", 3}, Word{"листья", 3}, Word{"листва", 3}, Word{"хвоя", 3}, Word{"цветок", 3},
    Word{"цветы", 3}, Word{"кора", -4}, Word{"ствол", -4}, Word{"ветка", -2}, Word{"ветки", -2},
    Word{"ветвь", -2}, Word{"ветви", -2}, Word{"дерево", -1}};

/// Parts of compounds ("Eichenblatt", "Baumrinde", "treebark"), at a word's beginning or end.
constexpr std::array kCompounds = {Word{"leaf", 3},     Word{"leaves", 3},  Word{"foliage", 3},
                                   Word{"blatt", 3},    Word{"blätter", 3}, Word{"blaetter", 3},
                                   Word{"laubwerk", 3}, Word{"nadeln", 3},  Word{"blüten", 3},
                                   Word{"flower", 2},   Word{"needles", 3}, Word{"листв", 3},
                                   Word{"trunk", -4},   Word{"stamm", -4},  Word{"rinde", -4},
                                   Word{"borke", -4},   Word{"bark", -4},   Word{"branches", -2}};

/// Scripts without blanks between words: anywhere.
constexpr std::array kAnywhere = {
    Word{"葉", 3},    Word{"叶", 3},        Word{"花", 2.5},  Word{"草", 2},    Word{"잎", 3},
    Word{"樹皮", -4}, Word{"树皮", -4},     Word{"树干", -4}, Word{"樹幹", -4}, Word{"幹", -3},
    Word{"枝", -2},   Word{"나무껍질", -4}, Word{"줄기", -3}};

double wordScore(const std::string& word) {
  for (const Word& entry : kWords)
    if (word == entry.text) return entry.score;
  // Compounds need a stem of their own: "leafy" and "debark" are none.
  for (const Word& entry : kCompounds)
    if (word.size() >= entry.text.size() + 3 &&
        (word.ends_with(entry.text) || (entry.text.size() > 4 && word.starts_with(entry.text))))
      return entry.score;
  for (const Word& entry : kAnywhere)
    if (word.find(entry.text) != std::string::npos) return entry.score;
  return 0.0;
}

}  // namespace

double nameScore(const std::string& name) {
  double most = 0.0, least = 0.0;
  for (const std::string& word : words(name)) {
    const double score = wordScore(word);
    most = std::max(most, score);
    least = std::min(least, score);
  }
  // A name with both ("branches_leaves", "leaf_stem"): what is shown is mostly the leaves.
  if (most > 0.0 && least < 0.0) return 0.5;
  return most + least;
}

bool matchesPattern(const std::string& raw_name, const std::string& raw_pattern) {
  const std::string name = lowered(raw_name), pattern = lowered(raw_pattern);
  std::size_t n = 0, p = 0, star = std::string::npos, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != std::string::npos) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace verdure
