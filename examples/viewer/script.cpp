/* SPDX-License-Identifier: MIT */
#include "script.h"

#include <SDL_keyboard.h>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace viewer {

namespace {

SDL_Event key_event(Uint32 type, SDL_Keycode key) {
    SDL_Event event = {};
    event.type = type;
    event.key.keysym.sym = key;
    event.key.keysym.scancode = SDL_GetScancodeFromKey(key);
    return event;
}

SDL_Event button_event(Uint32 type, int x, int y) {
    SDL_Event event = {};
    event.type = type;
    event.button.button = SDL_BUTTON_LEFT;
    event.button.x = x;
    event.button.y = y;
    return event;
}

SDL_Event motion_event(int x, int y) {
    SDL_Event event = {};
    event.type = SDL_MOUSEMOTION;
    event.motion.x = x;
    event.motion.y = y;
    return event;
}

/* The rest of the line, without blanks before it: names of keys and files may have some inside. */
std::string rest_of(std::istringstream &line) {
    std::string text;
    std::getline(line >> std::ws, text);
    return text;
}

} // namespace

bool Script::read_step(const std::string &text, Step &step) {
    std::istringstream line(text);
    std::string command;
    if (!(line >> step.frame >> command)) return false;
    if (command == "key") {
        const SDL_Keycode key = SDL_GetKeyFromName(rest_of(line).c_str());
        step.events = {key_event(SDL_KEYDOWN, key), key_event(SDL_KEYUP, key)};
        return key != SDLK_UNKNOWN;
    }
    if (command == "shot") {
        step.shot = rest_of(line);
        return !step.shot.empty();
    }
    if (command == "quit") {
        SDL_Event event = {};
        event.type = SDL_QUIT;
        step.events = {event};
        return true;
    }
    int x = 0, y = 0;
    if (!(line >> x >> y)) return false;
    step.events = {motion_event(x, y)};
    if (command == "press") step.events.push_back(button_event(SDL_MOUSEBUTTONDOWN, x, y));
    if (command == "release") step.events.push_back(button_event(SDL_MOUSEBUTTONUP, x, y));
    return command == "press" || command == "release" || command == "move";
}

Script::Script(const std::string &path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("can't read the script '" + path + "'");
    std::string text;
    for (size_t number = 1; std::getline(file, text); ++number) {
        if (text.empty() || text[0] == '#') continue;
        Step step = {};
        if (!read_step(text, step))
            throw std::runtime_error(path + ": line " + std::to_string(number) + " is no step: " + text);
        steps_.push_back(step);
    }
}

void Script::play(uint32_t frame, std::vector<std::string> &shots) const {
    for (const Step &step : steps_) {
        if (step.frame != frame) continue;
        if (!step.shot.empty()) shots.push_back(step.shot);
        for (SDL_Event event : step.events)
            if (SDL_PushEvent(&event) < 0) throw std::runtime_error(std::string("no more events: ") + SDL_GetError());
    }
}

} // namespace viewer
