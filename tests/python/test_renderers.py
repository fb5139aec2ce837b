"""Devices, threads, interruption, movies and the program."""

import gc
import os
import resource
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import SIZE

import edgesplat
from edgesplat import Error, Interrupted, Renderer, Scene, Volume

# A picture that takes seconds, for tests that interrupt it.
LONG = {"size": (512, 512), "effects": {"samples": 8}}


def test_devices(renderer):
    devices = edgesplat.list_devices()
    assert renderer.device in devices and renderer.device.rejections == ()
    with pytest.raises(Error, match="no-such-device"):
        Renderer("no-such-device")


def test_memory_budget(ball):
    with pytest.raises(Error, match="memory_budget: -1: expected MiB"):
        Renderer(memory_budget=-1)
    with Renderer(memory_budget=0.01) as small:
        with pytest.raises(Error, match="MiB|KiB"):
            small.render(ball, size=SIZE)


def test_a_volume_is_prepared_once(ball):
    with Renderer() as one:
        volume = Volume(ball)
        first = one.render(volume, size=SIZE)
        second = one.render(volume, size=SIZE)
        assert first.statistics.setup_ms > 0 and second.statistics.setup_ms == 0
        assert np.array_equal(first.color, second.color)


def test_validation(ball):
    with Renderer(validation=True, check_numbers=True) as one:
        one.render(ball, size=SIZE)
        assert one.validation_messages == 0


def test_keep_splats(ball, tmp_path, monkeypatch):
    monkeypatch.setenv("EDGESPLAT_CACHE", str(tmp_path))
    pictures = []
    for _ in range(2):
        with Renderer(keep_splats=True) as one:
            pictures.append(one.render(ball, size=SIZE))
    assert [picture.statistics.splats_read for picture in pictures] == [False, True]
    assert (pictures[0].color == pictures[1].color).all()


def test_closed(ball):
    one = Renderer()
    one.render(ball, size=SIZE)
    assert one.held_bytes > 0
    one.close()
    one.close()
    with pytest.raises(Error, match="the renderer is closed"):
        one.render(ball, size=SIZE)


def test_threads_share_a_renderer(renderer, ball):
    volumes = [Volume(ball), Volume(ball[:, ::-1, :16] + 1)]
    expected = [renderer.render(volume, size=SIZE).color for volume in volumes]
    wrong = []

    def work(place):
        for turn in range(4):
            which = (place + turn) % 2
            if not np.array_equal(renderer.render(volumes[which], size=SIZE).color, expected[which]):
                wrong.append((place, turn))

    threads = [threading.Thread(target=work, args=(place,)) for place in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_threads_with_their_own_renderers(ball):
    pictures = [None, None]

    def work(place):
        with Renderer() as own:
            pictures[place] = own.render(ball, size=SIZE).color

    threads = [threading.Thread(target=work, args=(place,)) for place in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert np.array_equal(*pictures)


def test_other_threads_continue(renderer, ball):
    """A thread counts while a picture is drawn; it could not count if the interpreter's lock were held."""
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        renderer.render(ball, size=(256, 256), effects={"samples": 3})
    finally:
        done.set()
        thread.join()
    assert counted[0] > 5


def test_interrupted_from_another_thread(renderer, ball):
    volume = Volume(ball)
    expected = renderer.render(volume, size=SIZE).color
    renderer.interrupt()  # no effect while nothing is drawn
    again = threading.Event()

    def stop():
        while not again.is_set():
            renderer.interrupt()
            time.sleep(0.02)

    thread = threading.Thread(target=stop)
    thread.start()
    try:
        with pytest.raises(Interrupted):
            renderer.render(volume, **LONG)
    finally:
        again.set()
        thread.join()
    assert np.array_equal(renderer.render(volume, size=SIZE).color, expected)


@pytest.mark.parametrize("kind", ["splat", "reference"])
def test_interrupted_by_signal(renderer, ball, kind):
    # A process that a shell started in the background ignores SIGINT.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def press():
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=press)
    begin = time.monotonic()
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            if kind == "splat":
                renderer.render(ball, **LONG)
            else:
                renderer.render(ball, size=(512, 512), output={"renderer": "reference", "tolerance": 1e-5})
            time.sleep(30)
    finally:
        thread.join()
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - begin < 20
    assert renderer.render(ball, size=SIZE).color.shape == (48, 64, 4)


def test_own_signal_handler(renderer, ball):
    """A signal whose handler raises no exception does not stop the picture."""
    seen = []
    before = signal.signal(signal.SIGUSR1, lambda *_: seen.append(1))
    timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGUSR1))
    try:
        timer.start()
        renderer.render(ball, size=(256, 256), effects={"samples": 3})
        timer.join()
        time.sleep(0.01)
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert seen == [1]


def test_no_memory_is_lost(renderer, ball):
    volume = Volume(ball)

    def resident():
        gc.collect()
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    for _ in range(10):
        renderer.render(volume, size=(256, 256))
    before = resident()
    for _ in range(40):
        renderer.render(volume, size=(256, 256))  # a leak would be 1 MiB each
    assert resident() - before < 20 << 20


ORBIT = {"orbit": {"degrees": 90, "seconds": 1}, "fps": 4}


def test_movie(renderer, program, tmp_path):
    scene = Scene(volume={"path": "builtin:sphere:24"}, movie=ORBIT, output={"size": SIZE})
    frames = renderer.movie(scene)
    assert len(frames) == 4 and frames.fps == 4
    pictures = list(frames)
    assert [picture.time for picture in pictures] == [0, 0.25, 0.5, 0.75]
    assert np.array_equal(frames[2].color, pictures[2].color)
    assert np.array_equal(frames[-1].color, pictures[3].color)
    assert not np.array_equal(pictures[0].color, pictures[1].color)
    with pytest.raises(IndexError, match="the movie has 4"):
        frames[4]
    (tmp_path / "scene.toml").write_text(scene.text())
    program("movie", tmp_path / "scene.toml", "-o", tmp_path / "frame_%d.exr", "-q")
    for place, picture in enumerate(pictures):
        picture.save(tmp_path / "ours.exr")
        program("compare", tmp_path / "ours.exr", tmp_path / f"frame_{place}.exr", "--max-diff", "0")


def test_movie_of_an_array(renderer, ball):
    animate = [{"key": "effects.fog.density", "times": [0, 1], "values": [0, 0.1]}]
    frames = renderer.movie(ball, effects={"fog": {"density": 0.01}}, movie={"animate": animate, "fps": 2}, size=SIZE)
    assert len(frames) == 2
    other = renderer.render(ball, size=SIZE)  # between two frames
    first, second = frames[0].color, frames[1].color
    assert not np.array_equal(first, second)
    assert np.array_equal(frames[0].color, first)
    assert other.color.shape == first.shape


def test_invalid_movies(renderer, ball):
    with pytest.raises(Error, match="the movie has no duration"):
        renderer.movie(ball)
    assert len(renderer.movie(ball, seconds=2)) == 50
    with pytest.raises(Error, match="a movie has no extra outputs and no comparisons"):
        renderer.movie(ball, seconds=1, output={"renderer": "reference"})


def test_the_program(program):
    said = program("--version")
    assert said.stdout.startswith(f"edgesplat {edgesplat.__version__}")
    assert program("render", check=False).returncode == 2


def test_import_needs_no_device():
    """The import does not open a device or load libraries that only pictures need."""
    code = "import edgesplat, sys; print(edgesplat.Volume('builtin:sphere:8').shape, 'numpy' in sys.modules)"
    environment = {**os.environ, "VK_DRIVER_FILES": "/nowhere", "PYTHONPATH": os.pathsep.join(sys.path)}
    environment["VK_ICD_FILENAMES"] = "/nowhere"
    said = subprocess.run([sys.executable, "-c", code], env=environment, check=True, capture_output=True, text=True)
    assert said.stdout.strip() == "(8, 8, 8) True"


def test_progress_is_reported(renderer):
    shares = []
    renderer.render("builtin:sphere:40", iso_values=[0.5], size=(16, 16), progress=shares.append)
    assert shares and shares == sorted(shares) and shares[-1] == 1
    # Nothing is waited for a second time.
    del shares[:]
    renderer.render("builtin:sphere:40", iso_values=[0.5], size=(16, 16), progress=shares.append)

    def stop(share):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        renderer.render("builtin:sphere:44", iso_values=[0.5], size=(16, 16), progress=stop)
    assert renderer.render("builtin:sphere:44", iso_values=[0.5], size=(16, 16)).color[..., 3].max() > 0.9
