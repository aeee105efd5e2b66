"""A session with the web server of a controller: requests one after the other on a connection that stays, with digest
(1.0) or basic login (2.0), cookies, and a limit of time and size for every answer.

Written on the standard library, because the usual clients repeat a PUT or DELETE by themselves when the connection is
lost, and who brings programs must know about every one.
"""

from __future__ import annotations

import base64
import contextlib
import hashlib
import http.client
import re
import secrets
import socket
import ssl
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

from rpl.controllers.abb.answers import Answer
from rpl.controllers.abb.calls import Generation
from rpl.controllers.link import GarbledError, LinkError, LostError
from rpl.controllers.profile import Profile

LARGEST_ANSWER = 8 * 2**20  # bytes; lists of files and signals are much smaller
_SLOWEST_BYTES_PER_S = 200_000.0  # a line that is slower than this is taken for lost
_IDLE_S = 5.0  # a connection that was not used for so long is opened anew: the controller may have closed it
_CHUNK = 2**16


@dataclass(slots=True)
class Digest:
    """The answer to a challenge (RFC 7616; ABB asks for MD5 and qop=auth)."""

    user: str
    password: str
    challenge: Mapping[str, str]
    count: int = 0

    def header(self, method: str, target: str) -> str:
        said = self.challenge
        name = said.get("algorithm", "MD5").upper()
        if name not in ("MD5", "SHA-256") or "nonce" not in said:
            raise GarbledError("the controller asks for a way of logging in that is not known")

        def hashed(text: str) -> str:
            data = text.encode()
            return (hashlib.md5(data, usedforsecurity=False) if name == "MD5" else hashlib.sha256(data)).hexdigest()

        self.count += 1
        count, mark = f"{self.count:08x}", secrets.token_hex(8)
        realm, nonce = said.get("realm", ""), said["nonce"]
        who = hashed(f"{self.user}:{realm}:{self.password}")
        response = hashed(f"{who}:{nonce}:{count}:{mark}:auth:{hashed(f'{method}:{target}')}")
        opaque = f', opaque="{said["opaque"]}"' if "opaque" in said else ""
        return (
            f'Digest username="{self.user}", realm="{realm}", nonce="{nonce}", uri="{target}", algorithm={name}, '
            f'response="{response}", qop=auth, nc={count}, cnonce="{mark}"{opaque}'
        )


class Session:
    """check(port, certificate): raises when the controller's certificate (DER) is not the one that is known."""

    def __init__(self, profile: Profile, generation: Generation, check: Callable[[int, bytes], None]) -> None:
        self.profile = profile
        self.generation = generation
        self.cookies: dict[str, str] = {}
        self.certificate = b""
        self._check = check
        self._digest: Digest | None = None
        self._connection: http.client.HTTPConnection | None = None
        self._used_s = 0.0

    def get(self, target: str, largest: int = LARGEST_ANSWER, raw: bool = False) -> Answer:
        """Ask; `raw`: for the bytes of a file, else for JSON."""
        if self.generation.number == "1" and not raw:
            target += ("&" if "?" in target else "?") + "json=1"
        return self._asked("GET", target, None, {"Accept": "*/*"} if raw else {}, largest)

    def post(self, target: str, **form: str) -> Answer:
        names = {key.replace("_", "-"): value for key, value in form.items()}
        body = urlencode(names, safe="$/;:").encode()
        if self.generation.number == "1":
            target += ("&" if "?" in target else "?") + "json=1"
        return self._asked("POST", target, body, {"Content-Type": self.generation.form})

    def put(self, target: str, data: bytes) -> Answer:
        return self._asked("PUT", target, data, {"Content-Type": self.generation.file})

    def delete(self, target: str) -> Answer:
        return self._asked("DELETE", target, None, {})

    @property
    def port(self) -> int:
        """That of the address is the one that carries files, in either generation."""
        profile, interface = self.profile, self.generation.interface
        if profile.port is not None and interface not in profile.ports:
            return profile.port
        return profile.port_of(interface)

    @property
    def cookie_header(self) -> str:
        return "; ".join(f"{name}={value}" for name, value in self.cookies.items())

    def close(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    # ---- one request

    def _asked(
        self,
        method: str,
        target: str,
        body: bytes | None,
        headers: Mapping[str, str],
        largest: int = LARGEST_ANSWER,
    ) -> Answer:
        """Logs in where that is asked for: what was refused for that was not carried out, and is asked once more."""
        answer, challenge = self._exchanged(method, target, body, headers, largest)
        if answer.status == 401 and challenge and self.generation.number == "1":
            if self._digest is not None and challenge.get("stale", "").lower() != "true":
                return answer
            self._digest = Digest(self.profile.user, self.profile.password, challenge)
            answer, _ = self._exchanged(method, target, body, headers, largest)
        return answer

    def _exchanged(
        self, method: str, target: str, body: bytes | None, headers: Mapping[str, str], largest: int
    ) -> tuple[Answer, Mapping[str, str]]:
        try:
            with _Limit(self) as limit:
                connection = self._open()
                limit.watch(connection, len(body or b""))
                connection.request(method, target, body, dict(self._headers(method, target)) | dict(headers))
                response = connection.getresponse()
                answer = Answer(response.status, self._body(response, largest, limit))
                self._keep_cookies(response)
                self._used_s = time.monotonic()
                if response.will_close:
                    self.close()
                return answer, _challenge(response.getheader("WWW-Authenticate", ""))
        except LinkError:
            self.close()
            raise
        except TimeoutError:
            self.close()
            raise LostError(f"{self.profile.name}: no answer came in time") from None
        except (ConnectionError, http.client.IncompleteRead, ssl.SSLError) as error:
            self.close()
            raise LostError(f"{self.profile.name}: the connection is lost: {error or 'it was closed'}") from None
        except http.client.HTTPException:
            self.close()
            raise GarbledError(f"{self.profile.name}: the answer is none of a web server") from None
        except OSError as error:
            self.close()
            raise LostError(f"{self.profile.name}: {error.strerror or error}") from None

    def _open(self) -> http.client.HTTPConnection:
        if self._connection is not None and time.monotonic() - self._used_s > _IDLE_S:
            self.close()
        if self._connection is None:
            profile, wait, port = self.profile, self.profile.patience_s, self.port
            if self.generation.secure:
                context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
                context.check_hostname, context.verify_mode = False, ssl.CERT_NONE  # the certificate is pinned
                secure = http.client.HTTPSConnection(profile.host, port, timeout=wait, context=context)
                secure.connect()
                self.certificate = secure.sock.getpeercert(True) or b""
                self._check(port, self.certificate)
                self._connection = secure
            else:
                self._connection = http.client.HTTPConnection(profile.host, port, timeout=wait)
                self._connection.connect()
        return self._connection

    def _headers(self, method: str, target: str) -> dict[str, str]:
        headers = {"Accept": self.generation.accepts}
        if self.cookies:
            headers["Cookie"] = self.cookie_header
        if self.generation.number == "2":
            who = f"{self.profile.user}:{self.profile.password}".encode()
            headers["Authorization"] = "Basic " + base64.b64encode(who).decode()
        elif self._digest is not None:
            headers["Authorization"] = self._digest.header(method, target)
        return headers

    def _keep_cookies(self, response: http.client.HTTPResponse) -> None:
        for each in response.headers.get_all("Set-Cookie", []):
            name, sign, value = each.partition(";")[0].partition("=")
            if sign:
                self.cookies[name.strip()] = value.strip()

    def _body(self, response: http.client.HTTPResponse, largest: int, limit: _Limit) -> bytes:
        announced = response.length or 0
        if announced > largest:
            raise GarbledError(f"{self.profile.name}: an answer of {announced} bytes is announced; that is too much")
        limit.extend(announced)
        parts, size = [], 0
        while chunk := response.read(_CHUNK):
            parts.append(chunk)
            size += len(chunk)
            if size > largest:
                raise GarbledError(f"{self.profile.name}: the answer has no end")
        limit.check()
        if size < announced:
            raise LostError(f"{self.profile.name}: the connection was lost in the middle of an answer")
        return b"".join(parts)


class _Limit:
    """Ends a request from outside when its time is over, however it goes on (a server that drips bytes)."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.is_over = False
        self._timer: threading.Timer | None = None
        self._socket: socket.socket | None = None

    def __enter__(self) -> _Limit:
        return self

    def watch(self, connection: http.client.HTTPConnection, size: int) -> None:
        self._socket = connection.sock
        self.extend(size)

    def extend(self, size: int) -> None:
        """From now on: the profile's patience, and what so many bytes take on the slowest line."""
        self._stop()
        self._timer = threading.Timer(self.session.profile.patience_s + size / _SLOWEST_BYTES_PER_S, self._end)
        self._timer.daemon = True
        self._timer.start()

    def _end(self) -> None:
        self.is_over = True
        if self._socket is not None:
            with contextlib.suppress(OSError):  # it is closed already
                self._socket.shutdown(socket.SHUT_RDWR)

    def _stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()

    def check(self) -> None:
        if self.is_over:
            raise LostError(f"{self.session.profile.name}: no whole answer came in time")

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        self._stop()
        if self.is_over and isinstance(error, OSError | http.client.HTTPException):
            self.session.close()
            self.check()


def _challenge(header: str) -> dict[str, str]:
    """What a Digest challenge says, by its words."""
    if not header.lower().startswith("digest "):
        return {}
    found = re.findall(r'(\w+)\s*=\s*(?:"([^"]*)"|([^\s,]+))', header[7:])
    return {name.lower(): quoted or bare for name, quoted, bare in found}
