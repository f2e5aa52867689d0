# What `make bench` runs beside VTK.
add_executable(bench_frames bench/frames.cpp)
target_link_libraries(bench_frames PRIVATE easypbr easypbr_options easypbr_dependencies)
add_executable(bench_recording bench/recording.cpp)
target_link_libraries(bench_recording PRIVATE easypbr easypbr_options easypbr_dependencies)
