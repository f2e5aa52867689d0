#include "easypbr/core/guarded_map.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <mutex>

namespace easypbr {
namespace {

/// Where a map lies. All zero: the slot is free; begin of 1: it is being filled.
struct MapSlot {
    std::atomic<uintptr_t> begin{0}, end{0};
    std::atomic<bool> broken{false};
};

// The handler of a signal may neither lock nor allocate.
std::array<MapSlot, 256> map_slots;

/// What SIGBUS did when this handler was put in front of it, the oldest first.
std::array<struct sigaction, 16> found_actions;
std::atomic<size_t> found_count{0};
std::atomic<void*> last_fault{nullptr};  ///< where one was passed on
std::mutex installing;

/// Puts zeros in place of the rest of the map, so that the instruction that failed goes on.
bool replace_rest(MapSlot& slot, uintptr_t address) {
    const uintptr_t page = uintptr_t(::sysconf(_SC_PAGESIZE));
    const uintptr_t begin = address / page * page;
    void* zeros = ::mmap(reinterpret_cast<void*>(begin), slot.end - begin, PROT_READ,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
    slot.broken = true;
    return zeros != MAP_FAILED;
}

bool is_page_fault(const siginfo_t& info) {
    return info.si_code > 0;  // A program has not sent it.
}

bool is_same(const struct sigaction& a, const struct sigaction& b) {
    const bool takes_info = a.sa_flags & SA_SIGINFO;
    if (takes_info != bool(b.sa_flags & SA_SIGINFO)) return false;
    return takes_info ? a.sa_sigaction == b.sa_sigaction : a.sa_handler == b.sa_handler;
}

void on_bus_error(int signal, siginfo_t* info, void* context);

struct sigaction own_action() {
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    return action;
}

/// Takes the newest action. Whoever returned from a fault that comes again at once, as a handler that has
/// been disabled meanwhile, is passed over.
struct sigaction taken_action(const siginfo_t& info) {
    const bool again = is_page_fault(info) && last_fault.exchange(info.si_addr) == info.si_addr;
    size_t count = found_count;
    if (again && count > 0) --count;
    found_count = count > 0 ? count - 1 : 0;
    struct sigaction none {};
    return count > 0 ? found_actions[count - 1] : none;
}

/// Has the action found do what it would without this handler. One that gives up, as that of Python's
/// faulthandler, puts back what it found itself, which is often this handler, and raises the signal again:
/// it is not called again then, but the one before it.
void pass_on(int signal, siginfo_t* info, void* context) {
    const struct sigaction action = taken_action(*info);
    ::sigaction(SIGBUS, &action, nullptr);
    const bool takes_info = action.sa_flags & SA_SIGINFO;
    if (!takes_info && (action.sa_handler == SIG_DFL || action.sa_handler == SIG_IGN)) {
        ::raise(signal);  // It comes again once this handler has returned.
        return;
    }
    if (takes_info)
        action.sa_sigaction(signal, info, context);
    else
        action.sa_handler(signal);
    struct sigaction now {};
    ::sigaction(SIGBUS, nullptr, &now);
    if (!is_same(now, action)) {
        last_fault = nullptr;
        return;
    }
    ++found_count;
    const struct sigaction own = own_action();
    ::sigaction(SIGBUS, &own, nullptr);
}

void on_bus_error(int signal, siginfo_t* info, void* context) {
    const int error = errno;
    const auto address = reinterpret_cast<uintptr_t>(info->si_addr);
    for (MapSlot& slot : map_slots)
        if (is_page_fault(*info) && address >= slot.begin && address < slot.end &&
            replace_rest(slot, address)) {
            errno = error;
            return;
        }
    pass_on(signal, info, context);
    errno = error;
}

bool is_installed(const struct sigaction& now) {
    return (now.sa_flags & SA_SIGINFO) && now.sa_sigaction == on_bus_error;
}

/// Puts this handler in front where another one has been installed since. False where it cannot be.
bool install_handler() {
    struct sigaction now {};
    if (::sigaction(SIGBUS, nullptr, &now) != 0) return false;
    if (is_installed(now)) return true;
    const std::lock_guard lock(installing);
    const struct sigaction own = own_action();
    if (::sigaction(SIGBUS, nullptr, &now) != 0) return false;
    if (is_installed(now)) return true;
    const size_t count = found_count;
    if (count == 0 || !is_same(found_actions[count - 1], now)) {
        if (count == found_actions.size()) return false;
        found_actions[count] = now;
        found_count = count + 1;
    }
    return ::sigaction(SIGBUS, &own, nullptr) == 0;
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
    if (!install_handler() || (slot_ = free_slot()) < 0) return;
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
