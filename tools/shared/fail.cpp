#include "fail.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>

void fail(const std::string& message) {
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, message.c_str());
    exit(2);
}

void print_manual(const char* manual) {
    fputs(manual, stdout);
    exit(0);
}
