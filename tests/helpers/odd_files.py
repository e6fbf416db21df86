"""What may stand in the place of a file, and is none."""

import os
import socket


def put_pipe(path):
    os.mkfifo(path)


def put_device(path):
    path.symlink_to("/dev/zero")


def put_folder(path):
    path.mkdir()


def put_lost_link(path):
    path.symlink_to("nowhere")


def put_loop(path):
    path.symlink_to(path.name)


def put_socket(path):
    # a socket's path may have hardly a hundred bytes
    here = os.open(path.parent, os.O_RDONLY)
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(f"/proc/self/fd/{here}/{path.name}")
    os.close(here)
