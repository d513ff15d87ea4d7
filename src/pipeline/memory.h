// Check of whether a picture fits into memory, before it is begun: afterwards the system may end the process
// without a word.
#pragma once

#include <functional>
#include <string>

namespace lumirank::pipeline {

// Bytes that this process can still get: the least of what its own limits, those of its control group and the
// machine leave. Infinite where none of them is known.
double available_memory();

// Bytes that a picture takes beside its scene, about: what brute force and the cheapest sampling have been
// measured to take at their peak. Methods may take more.
double memory_of_picture(double film_samples, double lights, bool layers);
double memory_of_reference(double pixels);

// Throws InputError for more film samples than 32 bits can number.
void require_countable(double film_samples);

// Throws InputError if that is more than there is. `remedy` names what can be made smaller.
void require_memory(double bytes, const std::string& remedy);

// Runs `work`; what runs out of memory in spite of the estimate becomes an InputError as well.
void within_memory(const std::string& remedy, const std::function<void()>& work);

inline constexpr const char* kSmallerPicture =
    "ask for fewer --lights, a smaller --size, a lower --spp or a --crop";

}  // namespace lumirank::pipeline
