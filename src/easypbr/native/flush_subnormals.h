// Arithmetic without subnormal numbers, as drivers' shaders have it.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace easypbr::native {

/// While it lives, subnormal numbers are zero in the calling thread's arithmetic, as operands and as results.
/// Processors compute them in microcode, a hundred times as slowly as others; weights that fall exponentially
/// are full of them.
class FlushSubnormals {
  public:
    FlushSubnormals() : before_(control()) { set_control(before_ | flush); }
    ~FlushSubnormals() { set_control(before_); }
    FlushSubnormals(const FlushSubnormals&) = delete;
    FlushSubnormals& operator=(const FlushSubnormals&) = delete;

  private:
#if defined(__x86_64__)
    /// Of MXCSR: results (FTZ) and operands (DAZ).
    static constexpr uint32_t flush = 0x8040;
    using Control = uint32_t;
    static Control control() {
        return _mm_getcsr();
    }
    static void set_control(Control value) {
        _mm_setcsr(value);
    }
#elif defined(__aarch64__)
    /// Of FPCR: FZ.
    static constexpr uint64_t flush = 1u << 24;
    using Control = uint64_t;
    static Control control() {
        Control value;
        asm volatile("mrs %0, fpcr" : "=r"(value));
        return value;
    }
    static void set_control(Control value) {
        asm volatile("msr fpcr, %0" : : "r"(value));
    }
#else
    static constexpr int flush = 0;
    using Control = int;
    static Control control() {
        return 0;
    }
    static void set_control(Control /*value*/) {}
#endif

    Control before_;
};

}  // namespace easypbr::native
