/* SPDX-License-Identifier: MIT */
/* text.h: words from files that nobody has checked, made fit for a terminal. */
#ifndef DEMO_TEXT_H
#define DEMO_TEXT_H

#include <string>

namespace demo {

/** One line without control characters, of bounded length. */
inline std::string one_line(std::string text) {
    constexpr size_t longest = 500;
    if (text.size() > longest) text = text.substr(0, longest) + " ...";
    for (char &c : text)
        if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

} // namespace demo

#endif
