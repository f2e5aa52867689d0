#include "easypbr/core/guarded_map.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>

namespace easypbr {
namespace {

/// Where a map lies. All zero: the slot is free; begin of 1: it is being filled.
struct MapSlot {
    std::atomic<uintptr_t> begin{0}, end{0};
    std::atomic<bool> broken{false};
};

// The handler of a signal may neither lock nor allocate.
std::array<MapSlot, 256> map_slots;
struct sigaction previous_action;

/// Puts zeros in place of the rest of the map, so that the instruction that failed goes on.
bool replace_rest(MapSlot& slot, uintptr_t address) {
    const uintptr_t page = uintptr_t(::sysconf(_SC_PAGESIZE));
    const uintptr_t begin = address / page * page;
    void* zeros = ::mmap(reinterpret_cast<void*>(begin), slot.end - begin, PROT_READ,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
    slot.broken = true;
    return zeros != MAP_FAILED;
}

void on_bus_error(int signal, siginfo_t* info, void* context) {
    const int error = errno;
    const auto address = reinterpret_cast<uintptr_t>(info->si_addr);
    const bool is_of_a_page = info->si_code > 0;  // and was not sent by a program
    for (MapSlot& slot : map_slots)
        if (is_of_a_page && address >= slot.begin && address < slot.end && replace_rest(slot, address)) {
            errno = error;
            return;
        }
    if (previous_action.sa_flags & SA_SIGINFO) return previous_action.sa_sigaction(signal, info, context);
    if (previous_action.sa_handler != SIG_DFL && previous_action.sa_handler != SIG_IGN)
        return previous_action.sa_handler(signal);
    // As if this handler had never been: the signal comes again once it has returned.
    ::sigaction(SIGBUS, &previous_action, nullptr);
    ::raise(signal);
}

bool install_handler() {
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    return ::sigaction(SIGBUS, &action, &previous_action) == 0;
}

int free_slot() {
    for (size_t i = 0; i < map_slots.size(); ++i) {
        uintptr_t free = 0;
        if (map_slots[i].begin.compare_exchange_strong(free, 1)) return int(i);
    }
    return -1;
}

}  // namespace

GuardedMap::GuardedMap(int descriptor, size_t size) {
    static const bool is_guarded = install_handler();
    if (!is_guarded || (slot_ = free_slot()) < 0) return;
    MapSlot& slot = map_slots[size_t(slot_)];
    void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (data == MAP_FAILED) {
        slot.begin = 0;
        slot_ = -1;
        return;
    }
    ::madvise(data, size, MADV_WILLNEED);
    slot.broken = false;
    slot.begin = reinterpret_cast<uintptr_t>(data);
    slot.end = slot.begin + size;
}

GuardedMap::~GuardedMap() {
    if (slot_ < 0) return;
    MapSlot& slot = map_slots[size_t(slot_)];
    const uintptr_t begin = slot.begin, size = slot.end - begin;
    slot.end = 0;
    ::munmap(reinterpret_cast<void*>(begin), size);
    slot.begin = 0;
}

const std::byte* GuardedMap::data() const {
    return reinterpret_cast<const std::byte*>(map_slots[size_t(slot_)].begin.load());
}

bool GuardedMap::is_broken() const {
    return slot_ >= 0 && map_slots[size_t(slot_)].broken;
}

}  // namespace easypbr
