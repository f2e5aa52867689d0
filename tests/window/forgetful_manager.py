"""A window manager that loses the first request to map a window, as one that is just starting does. Xlib by ctypes."""
import ctypes

SUBSTRUCTURE_REDIRECT = 1 << 20
MAP_REQUEST = 20


class MapRequest(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("parent", ctypes.c_ulong), ("window", ctypes.c_ulong)]


class Event(ctypes.Union):
    _fields_ = [("type", ctypes.c_int), ("map_request", MapRequest), ("room", ctypes.c_long * 24)]


x11 = ctypes.CDLL("libX11.so.6")
x11.XOpenDisplay.restype = ctypes.c_void_p
x11.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
x11.XDefaultRootWindow.restype = ctypes.c_ulong
x11.XSelectInput.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_long]
x11.XNextEvent.argtypes = [ctypes.c_void_p, ctypes.POINTER(Event)]
x11.XMapWindow.argtypes = [ctypes.c_void_p, ctypes.c_ulong]
x11.XSync.argtypes = [ctypes.c_void_p, ctypes.c_int]

display = x11.XOpenDisplay(None)
x11.XSelectInput(display, x11.XDefaultRootWindow(display), SUBSTRUCTURE_REDIRECT)
x11.XSync(display, 0)
print("ready", flush=True)
event, requests = Event(), 0
while True:
    x11.XNextEvent(display, ctypes.byref(event))
    if event.type == MAP_REQUEST:
        requests += 1
        print("map", requests, flush=True)
        if requests > 1:
            x11.XMapWindow(display, event.map_request.window)
            x11.XSync(display, 0)
