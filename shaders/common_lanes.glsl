// Native shaders shade several pixels at once: `if` and loops need conditions that are the same for all of them.
#define any_lane(condition) (condition)
