#pragma once

#include <string>

// Ends the program: one line on standard error, exit status 2.
[[noreturn]] void fail(const std::string& message);

// Prints a manual on standard output and ends the program with status 0.
[[noreturn]] void print_manual(const char* manual);
