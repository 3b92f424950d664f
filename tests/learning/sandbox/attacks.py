"""The actions of malicious or mistaken students' programs; each text is a Python program."""

from __future__ import annotations

FORK_BOMB = """
import os, signal
signal.signal(signal.SIGTERM, signal.SIG_IGN)
while True:
    try:
        if os.fork() == 0:
            os.setsid()
    except OSError:
        pass
"""

DAEMONS = """
import os, time
for _ in range(5):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.setsid()
            os.closerange(0, 3)
            while True:
                open("alive", "a").close()
                time.sleep(0.01)
        os._exit(0)
while not os.path.exists("alive"):
    time.sleep(0.01)
print(os.getpid())
"""

ENDLESS_LOOP = """
import signal
for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
    signal.signal(number, signal.SIG_IGN)
print("begun", flush=True)
while True:
    pass
"""

MANY_LOOPS = """
import os
for _ in range(3):
    os.fork()
while True:
    pass
"""

SLEEP = """
import signal, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
time.sleep(1000)
"""

LARGE_FILE = """
with open("large", "wb") as file:
    try:
        file.truncate(100_000_000_000)
    except OSError as error:
        print("sparse:", error.strerror, flush=True)
    while True:
        file.write(bytes(1 << 20))
"""

MANY_SMALL_FILES = """
import os
os.mkdir("small")
for number in range(10_000_000):
    with open(f"small/{number}", "wb") as file:
        file.write(b"x")
"""

DEEP_FOLDERS = """
import os
for _ in range(1_000_000):
    os.mkdir("d" * 200)
    os.chdir("d" * 200)
"""

DELETED_FILE = """
import os
number = 0
while True:
    file = os.open(f"large{number}", os.O_CREAT | os.O_WRONLY)
    os.unlink(f"large{number}")
    number += 1
    for _ in range(30):
        os.write(file, bytes(1 << 20))
"""

MEMORY = """
import os
os.fork()
os.fork()
blocks = []
while True:
    try:
        blocks.append(bytearray(b"x") * (1 << 20))
    except MemoryError:
        pass
"""

SHARED_MEMORY = """
import mmap
blocks = []
while True:
    block = mmap.mmap(-1, 16 << 20)
    for place in range(0, 16 << 20, 4096):
        block[place] = 1
    blocks.append(block)
"""

NAMELESS_FILES_IN_MEMORY = """
import os
files = []
while True:
    file = os.memfd_create("hidden")
    files.append(file)
    for _ in range(30):
        os.write(file, bytes(1 << 20))
"""

OUTPUT = """
import sys
while True:
    sys.stdout.write("x" * 65536)
    sys.stderr.write("y" * 65536)
"""

TEMPORARY_FOLDERS = ("/tmp", "/dev/shm", "/var/tmp", "/run", "/run/lock")
FILL_TEMPORARY = (
    f"TEMPORARY_FOLDERS = {TEMPORARY_FOLDERS}"
    """
import os, sys
for folder in TEMPORARY_FOLDERS:
    written = 0
    try:
        for number in range(64):
            with open(f"{folder}/fill-{sys.argv[-1]}-{number}", "wb") as file:
                written += file.write(bytes(1 << 20))
    except OSError:
        pass
    print(folder, written, flush=True)
"""
)

TRAPS = """
import os
os.symlink("/etc/passwd", "outside")
os.symlink("../neighbor/secret", "neighbor")
os.symlink(".", "inside")
os.mkdir("package")
os.symlink("../package/../../neighbor", "package/further")
os.symlink("data", "package/link")
os.mkfifo("pipe")
import socket
os.symlink("/", "root")
os.mkdir("closed")
open("closed/file", "w").close()
os.chmod("closed/file", 0)
os.chmod("closed", 0)
open("program", "w").close()
os.chmod("program", 0o4777)
"""

TRESPASS = """
import ctypes, json, os, signal, socket, sys
neighbor, grader, port, server = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
libc = ctypes.CDLL(None, use_errno=True)
outcomes = {}

def attempt(name, action):
    try:
        outcomes[name] = action() is not False
    except OSError:
        outcomes[name] = False

def connect(family, address):
    with socket.socket(family) as client:
        client.settimeout(0.3)
        client.connect(address)

def find_route():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.connect(("192.0.2.1", 9))

def write(path):
    with open(path, "w") as file:
        file.write("mine")

attempt("read a neighbor's file", lambda: open(neighbor + "/secret").read())
attempt("list a neighbor's folder", lambda: os.listdir(neighbor))
attempt("read by /proc/self/root", lambda: open("/proc/self/root" + neighbor + "/secret").read())
attempt("read by the grader's root", lambda: open(f"/proc/{grader}/root{neighbor}/secret").read())
attempt("write into a neighbor's folder", lambda: write(neighbor + "/new"))
attempt("change a neighbor's file", lambda: write(neighbor + "/secret"))
attempt("truncate a neighbor's file", lambda: os.truncate(neighbor + "/secret", 0))
attempt("link a neighbor's file", lambda: os.link(neighbor + "/secret", "stolen"))
attempt("write above its folder", lambda: write("../above"))
attempt("write into /var/tmp", lambda: write("/var/tmp/linkwright-sandbox-test"))
attempt("write into Python", lambda: write(os.path.dirname(os.__file__) + "/linkwright_sandbox_test.py"))
attempt("read the grader's environment", lambda: open(f"/proc/{grader}/environ", "rb").read())
attempt("open the grader's memory", lambda: open(f"/proc/{grader}/mem", "r+b"))
attempt("trace the grader", lambda: libc.ptrace(16, grader, 0, 0) == 0)
attempt("trace its parent", lambda: libc.ptrace(16, os.getppid(), 0, 0) == 0)
attempt("signal the grader", lambda: os.kill(grader, 0))
attempt("reach a server on this host", lambda: connect(socket.AF_INET, ("127.0.0.1", port)))
attempt("reach another host", find_route)
attempt("reach a server by a file", lambda: connect(socket.AF_UNIX, server))
attempt("mount", lambda: libc.mount(b"none", b"/mnt", b"tmpfs", 0, None) == 0)
attempt("gain rights", lambda: os.setuid(0) if os.getuid() else False)
for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
    try:
        os.kill(os.getppid(), number)
    except OSError:
        pass
print(json.dumps(outcomes), flush=True)
"""

KILL_ALL = """
import os, signal
signal.signal(signal.SIGTERM, signal.SIG_IGN)
for number in (signal.SIGTERM, signal.SIGKILL):
    try:
        os.kill(-1, number)
    except OSError:
        pass
print("alive")
"""
