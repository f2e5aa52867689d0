#include "easypbr/python/job.h"

#include <nanobind/nanobind.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/variable.h"
#include "easypbr/python/text.h"

namespace nb = nanobind;

namespace easypbr::python {
namespace {

std::atomic<bool> interrupted = false;  ///< by SIGINT, during a job of the main thread
std::atomic<bool> ending = false;       ///< the interpreter
std::atomic<int> running = 0;           ///< jobs of threads other than the main one
struct sigaction python_action;         ///< what SIGINT does while no job watches
bool is_watching = false;
bool cancels_task = false;  ///< the handler of Python's that is watched for: it is asyncio's
unsigned long main_thread;  ///< as Python's threads are numbered on Linux
pid_t process;
PyObject *get_handler, *default_handler;  // Never freed: they are used until the interpreter has ended.

bool on_main_thread() {
    return static_cast<unsigned long>(pthread_self()) == main_thread;
}

/// Notes the signal and hands it on to Python, which raises KeyboardInterrupt when the job is over.
void on_interrupt(int number, siginfo_t* info, void* context) {
    interrupted = true;
    if (python_action.sa_flags & SA_SIGINFO)
        python_action.sa_sigaction(number, info, context);
    else
        python_action.sa_handler(number);
}

/// Whether a handler is that of asyncio.run() (Python 3.11 and newer), which cancels the main task.
bool is_of_asyncio(nb::handle handler) {
    PyObject* const runners = PyDict_GetItemString(PyImport_GetModuleDict(), "asyncio.runners");
    if (!runners) return false;
    const nb::object runner = nb::getattr(runners, "Runner", nb::none());
    const nb::object wanted = nb::getattr(runner, "_on_sigint", nb::none());
    const nb::object partial = nb::getattr(handler, "func", nb::none());
    return !wanted.is_none() && nb::getattr(partial, "__func__", nb::none()).is(wanted);
}

/// Whether it is a handler of Python's own that waits for SIGINT.
bool is_python_s_handler() {
    const nb::object handler = nb::steal(PyObject_CallFunction(get_handler, "i", SIGINT));
    if (!handler.is_valid()) throw nb::python_error();
    cancels_task = handler.ptr() != default_handler && is_of_asyncio(handler);
    return cancels_task || handler.ptr() == default_handler;
}

void watch() {
    interrupted = false;
    sigaction(SIGINT, nullptr, &python_action);
    struct sigaction action = python_action;
    action.sa_flags |= SA_SIGINFO;
    action.sa_sigaction = on_interrupt;
    sigaction(SIGINT, &action, nullptr);
    is_watching = true;
}

void stop_watching() {
    is_watching = false;
    struct sigaction now = {};
    sigaction(SIGINT, nullptr, &now);
    // A callback of the job's may have set another handler.
    if ((now.sa_flags & SA_SIGINFO) && now.sa_sigaction == on_interrupt)
        sigaction(SIGINT, &python_action, nullptr);
}

/// Called by atexit, with the GIL: daemon threads are still there, and would be ended by force at their next
/// step in Python.
void end_jobs() {
    if (getpid() != process) return;  // Threads do not survive a fork.
    ending = true;
    // What the frames of daemon threads hold is never freed.
    if (nb::cast<int>(nb::module_::import_("threading").attr("active_count")()) > 1)
        nb::set_leak_warnings(false);
    const nb::gil_scoped_release release;
    constexpr std::chrono::seconds patience(5);
    const auto start = std::chrono::steady_clock::now();
    while (running > 0 && std::chrono::steady_clock::now() - start < patience)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// A thread that asked for the GIL now would be ended by force, with the library's functions on its stack.
void stay_if_ending() {
    if (!ending || on_main_thread()) return;
    --running;
    while (true) pause();
}

/// Called by the interpreter, between two steps of the main thread.
int raise_pending(void* pending) {
    const std::unique_ptr<nb::python_error> error(static_cast<nb::python_error*>(pending));
    error->restore();
    return -1;
}

}  // namespace

Job::Job() {
    if (on_main_thread()) {
        watches_ = !is_watching && is_python_s_handler();
        if (watches_) watch();
        // Within a callback of another job that one's watch goes on.
        if (is_watching) scope_.emplace([] { return interrupted.load(std::memory_order_relaxed); });
    } else {
        ++running;
        scope_.emplace([] { return ending.load(std::memory_order_relaxed); });
    }
}

Job::~Job() {
    if (watches_) stop_watching();
    if (!on_main_thread()) --running;
}

void Job::raise() {
    // Python's own handler raises; unless a callback of the job's has met the signal before. asyncio's does
    // not: the task that it cancels shall end as at an await, which asyncio.run() makes a KeyboardInterrupt.
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (on_main_thread() && cancels_task)
        PyErr_SetNone(nb::module_::import_("asyncio").attr("CancelledError").ptr());
    else
        PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw nb::python_error();
}

Job::Running::Running() {
    stay_if_ending();
}

Job::Running::~Running() {
    stay_if_ending();
}

void raise_later(nb::python_error error, const char* context) {
    auto pending = std::make_unique<nb::python_error>(std::move(error));
    if (on_main_thread() && Py_AddPendingCall(raise_pending, pending.get()) == 0)
        static_cast<void>(pending.release());  // raise_pending() owns it.
    else
        pending->discard_as_unraisable(context);
}

void throw_as_own(const nb::python_error& error) {
    if (error.matches(PyExc_KeyboardInterrupt)) throw Interrupted();
    if (error.matches(PyExc_MemoryError)) throw std::bad_alloc();
    throw Error(nb::cast<std::string>(nb::str(error.value())));
}

void bind_jobs() {
    // torch, among others, keeps objects until after the interpreter has ended, where nothing is wrong.
    if (variable("EASYPBR_LEAK_WARNINGS").value_or("0") == "0") nb::set_leak_warnings(false);
    main_thread =
        nb::cast<unsigned long>(nb::module_::import_("threading").attr("main_thread")().attr("ident"));
    process = getpid();
    const nb::module_ signal = nb::module_::import_("signal");
    get_handler = nb::object(signal.attr("getsignal")).release().ptr();
    default_handler = nb::object(signal.attr("default_int_handler")).release().ptr();
    nb::module_::import_("atexit").attr("register")(nb::cpp_function(end_jobs));
}

}  // namespace easypbr::python
