#pragma once

namespace passung::field {

/// Instruction sets that inner loops are compiled for (x86-64-v3: AVX2, x86-64-v4: AVX-512); each includes those
/// before. The results have the same bits.
enum class Instructions { Baseline, V3, V4 };

/// The last one that this machine has.
Instructions bestInstructions() noexcept;

}  // namespace passung::field

/// A function compiled for an instruction set; what it calls must be PASSUNG_INLINE to be compiled for it as well.
#if defined(__x86_64__) && defined(__clang__)
#define PASSUNG_V3 __attribute__((target("arch=x86-64-v3")))
#define PASSUNG_V4 __attribute__((target("arch=x86-64-v4")))
#elif defined(__x86_64__)
#define PASSUNG_V3 __attribute__((target("arch=x86-64-v3")))
#define PASSUNG_V4 __attribute__((target("arch=x86-64-v4,prefer-vector-width=512")))
#else
#define PASSUNG_V3
#define PASSUNG_V4
#endif
/// At the end of such a function: compilers leave the upper halves of registers in use on some ways out, and from then
/// on all baseline code of the thread takes twice the time.
#if defined(__x86_64__)
#define PASSUNG_CLEAR_UPPER() __builtin_ia32_vzeroupper()
#else
#define PASSUNG_CLEAR_UPPER()
#endif
#define PASSUNG_INLINE inline __attribute__((always_inline))
