"""One call as it goes over the wire: how long the provider took, what it sent, and an end in time."""

import threading
import time
from collections.abc import Callable, Mapping
from queue import Empty, SimpleQueue
from typing import Any, TypeVar

T = TypeVar("T")

_SECONDS_TO_BEGIN = 10.0
"""At most so long a call may take before anything is sent: the first one imports a provider's client."""


class Exchange:
    """What litellm tells its `logger_fn` of one call; figures are None until they are known."""

    def __init__(self) -> None:
        self.sent = threading.Event()
        self.seconds: float | None = None
        """Between the request and the end of the answer."""
        self.body: str | None = None
        """The answer as it came, mostly JSON."""
        self._begun = 0.0

    def listen(self, details: Mapping[str, Any]) -> None:
        """The `logger_fn`."""
        event = details.get("log_event_type")
        if event == "pre_api_call" and not self.sent.is_set():
            self._begun = time.perf_counter()
            self.sent.set()
        elif event == "post_api_call" and self.sent.is_set() and self.seconds is None:
            self.seconds = time.perf_counter() - self._begun
            body = details.get("original_response")
            self.body = body if isinstance(body, str) else None

    def run(self, call: Callable[[], T], seconds: float) -> T:
        """What the call returns or raises; TimeoutError if the provider takes longer than these seconds."""
        return within(seconds, call, self.sent)


def within(seconds: float, call: Callable[[], T], begun: threading.Event | None = None) -> T:
    """What a call returns or raises; TimeoutError if that takes longer, counted from when it is `begun`.

    The timeouts of HTTP clients restart with every byte that arrives. So the call has a thread, which
    is left behind when time is up and keeps no process alive.
    """
    done: SimpleQueue[tuple[Callable[[], T], BaseException | None]] = SimpleQueue()

    def work() -> None:
        try:
            result = call()
            done.put((lambda: result, None))
        except BaseException as error:  # the caller must get every error of the thread
            done.put((call, error))
        finally:
            if begun is not None:
                begun.set()

    threading.Thread(target=work, daemon=True).start()
    if begun is not None:
        begun.wait(_SECONDS_TO_BEGIN)
    try:
        value, error = done.get(timeout=seconds)
    except Empty:
        raise TimeoutError from None
    if error is not None:
        raise error
    return value()
