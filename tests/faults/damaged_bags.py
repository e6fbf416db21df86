"""Bags damaged at random places, and which of their messages are still whole."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from helpers import bag_making
from scanplan.recordings import bags
from scanplan.recordings.salvage import salvaged_reader

FORMATS = ("ros1", "mcap", "sqlite3")
WAYS = ("noise", "zeros", "cut", "bit", "drop")
_PAGE = 4096
_BEFORE = 64  # bytes of a record's head, before a message's content


@dataclass(frozen=True)
class Outcome:
    """What salvage made of one damaged bag: numbers of messages."""

    way: str
    whole: int
    missed: int
    invented: int
    altered: int
    untold: int


class DamagedBag:
    """A bag of some megabytes, damaged anew by every call, and put right again."""

    def __init__(self, folder, kind, n_scans=100):
        self.kind = kind
        maker = bag_making.Maker(kind)
        points = np.random.default_rng(1).normal(size=(2000, 3)).astype(np.float32)
        entries = [
            (topic, t_ns, maker.cloud(t_ns, points + i) if topic == "/points" else message)
            for i, (topic, t_ns, message) in enumerate(bag_making.survey(maker, n_scans=n_scans))
        ]
        self.recording = maker.write(Path(folder, kind), entries)
        self.file = self.recording
        if self.recording.is_dir():
            self.file = next(f for f in self.recording.iterdir() if f.suffix in (".mcap", ".db3"))
        self.sound = self.file.read_bytes()
        self.messages = read_salvaged(self.recording)[0]
        self._places = self._find_places()

    def try_salvage(self, seed):
        """Damage the bag, salvage it, and compare with what it held."""
        rng = np.random.default_rng(seed)
        way, content, hit = damage(self.sound, rng)
        self.file.write_bytes(content)
        try:
            found, loss = read_salvaged(self.recording)
        finally:
            self.file.write_bytes(self.sound)
        held = Counter(self.messages)
        same = Counter(found) & held
        altered = Counter(found) - held
        have = {(topic, t_ns) for topic, t_ns, _ in same}
        known = {(topic, t_ns) for topic, t_ns, _ in self.messages}
        whole = [key for key, pieces in self._places if self._is_whole(pieces, hit, way)]
        return Outcome(
            way,
            len(whole),
            sum(key not in have for key in whole),
            sum((topic, t_ns) not in known for topic, t_ns, _ in found),
            altered.total(),
            int(same.total() + altered.total() < held.total() and not loss),
        )

    def _is_whole(self, pieces, hit, way):
        # pages behind bytes that are gone lie where none of them belongs
        if self.kind == "sqlite3" and way == "drop":
            return all(end <= hit[0] for _, end in pieces)
        return all(end <= hit[0] or begin >= hit[1] for begin, end in pieces)

    def _find_places(self):
        """Return, of each message, its topic and time and the bytes that it depends on."""
        found = salvaged_reader.find_records(self.file)
        self.found = found.messages
        places = []
        for message in found.messages:
            pieces = [(begin - _BEFORE, begin + size) for begin, size in message.pieces]
            if self.kind == "sqlite3":
                # the head of its page as well
                pieces.append((message.pieces[0][0] // _PAGE * _PAGE, message.pieces[0][0]))
            topic = found.connections[message.connection].topic
            places.append(((topic, message.t_ns), pieces))
        found.close()
        return places


def damage(content, rng):
    """Return how, and the damaged content, and from where to where it differs."""
    way = str(rng.choice(WAYS))
    place = int(rng.integers(len(content)))
    size = min(int(rng.choice([1, 16, 512, 4096, 40_000])), len(content) - place)
    before, after = content[:place], content[place + size :]
    if way == "noise":
        return way, before + rng.bytes(size) + after, (place, place + size)
    if way == "zeros":
        return way, before + bytes(size) + after, (place, place + size)
    if way == "cut":
        return way, before, (place, len(content))
    if way == "drop":
        return way, before + after, (place, place + size)
    flipped = bytes([content[place] ^ 1 << int(rng.integers(8))])
    return way, before + flipped + content[place + 1 :], (place, place + 1)


def read_salvaged(recording):
    """Return (topic, receive time, content) of what is whole of a recording, and what is lost."""
    with bags.open_bag(recording, salvage=True) as bag:
        names = {topic.name for topic in bag.topics}
        found = [(c.topic, t_ns, bytes(raw)) for c, t_ns, raw in bag.messages(names)]
        return found, bag.describe_loss()
