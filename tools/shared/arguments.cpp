#include "arguments.h"

#include "fail.h"

#include <cstdio>
#include <cstdlib>

bool Arguments::next() {
    if (index_ + 1 >= count_)
        return false;
    word_ = words_[++index_];
    return true;
}

std::string Arguments::value() {
    if (index_ + 1 >= count_)
        fail(word_ + " needs a value");
    return words_[++index_];
}

int Arguments::integer() {
    std::string text = value();
    char* end = nullptr;
    long number = strtol(text.c_str(), &end, 10);
    if (end == text.c_str() || *end)
        fail(word_ + " needs a whole number, not " + text);
    return (int)number;
}

double Arguments::number() {
    std::string text = value();
    char* end = nullptr;
    double number = strtod(text.c_str(), &end);
    if (end == text.c_str() || *end)
        fail(word_ + " needs a number, not " + text);
    return number;
}

void Arguments::integer_pair(int& first, int& second) {
    if (sscanf(value().c_str(), "%d,%d", &first, &second) != 2)
        fail(word_ + " needs two whole numbers with a comma between them");
}
