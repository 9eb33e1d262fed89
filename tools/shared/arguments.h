#pragma once

#include <string>

// The words of a command line, one after another.
class Arguments {
public:
    Arguments(int argc, char** argv) : count_(argc), words_(argv) {}

    // Moves to the next word; false after the last one.
    bool next();
    const std::string& word() const { return word_; }
    bool is(const char* option) const { return word_ == option; }
    bool is_option() const { return word_.size() > 1 && word_[0] == '-'; }

    // The word after the current option; fails where there is none, or no number.
    std::string value();
    int integer();
    double number();
    // The value `first,second`.
    void integer_pair(int& first, int& second);

private:
    int count_;
    char** words_;
    int index_ = 0;
    std::string word_;
};
