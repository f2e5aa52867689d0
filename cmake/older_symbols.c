/* What --wrap of cmake/portable.cmake puts in the place of functions whose default version is too new. The older
   versions differ in what does not matter here: hypot reports overflow through errno too, and the wait of a condition
   variable is not declared noexcept. */
double older_hypot(double x, double y);
float older_hypotf(float x, float y);
void older_wait(void* condition, void* lock);

__asm__(".symver older_hypot, hypot@GLIBC_2.2.5");
__asm__(".symver older_hypotf, hypotf@GLIBC_2.2.5");
__asm__(".symver older_wait, _ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE@GLIBCXX_3.4.11");

double __wrap_hypot(double x, double y);
float __wrap_hypotf(float x, float y);
void __wrap__ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE(void* condition, void* lock);

double __wrap_hypot(double x, double y) {
    return older_hypot(x, y);
}

float __wrap_hypotf(float x, float y) {
    return older_hypotf(x, y);
}

void __wrap__ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE(void* condition, void* lock) {
    older_wait(condition, lock);
}
