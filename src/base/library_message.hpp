#pragma once
#include <exception>
#include <string>

namespace lockstep {

/// Message of an exception of another library, fit for the middle of a sentence: on one line, of
/// bounded length, without the places in its sources that Trilinos puts first.
std::string library_message(const std::exception& error);

}  // namespace lockstep
