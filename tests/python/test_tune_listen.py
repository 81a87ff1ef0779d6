"""The page for other machines: refused without TLS and a token, and what it then lets in."""

import http.client
import ssl
import subprocess

import pytest

from stillspin.errors import InputError
from stillspin.tune.guard import Guard
from stillspin.tune.listen import outside
from stillspin.tune.server import Server

TOKEN = "abcdefghijklmnopqrstuvwxyz-0123"


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Certificate, key and token."""
    home = tmp_path_factory.mktemp("tls")
    certificate, key, token = home / "certificate.pem", home / "key.pem", home / "token"
    names = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"]
    out = ["-keyout", str(key), "-out", str(certificate)]
    making = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", *names, *out]
    subprocess.run(making, check=True, capture_output=True)
    token.write_text(TOKEN + "\n")
    token.chmod(0o600)
    return certificate, key, token


def test_nothing_is_asked_for_by_default():
    assert outside("", None, None, None) is None
    assert Guard().names == ("127.0.0.1", "localhost", "[::1]")


@pytest.mark.parametrize("missing", [(0,), (1,), (2,), (0, 1), (0, 1, 2)])
def test_it_is_refused_without_both(files, missing):
    given = [None if at in missing else file for at, file in enumerate(files)]
    with pytest.raises(InputError, match="refused without"):
        outside("192.0.2.1", *given)


def test_the_command_refuses_before_it_opens_a_drive(call):
    result = call("tune", "--drive", "/dev/none", "--listen", "192.0.2.1")
    assert result.exit_code == 2
    assert "refused without --certificate and --key and --token-file" in result.output


def test_what_is_too_weak_is_refused(files, tmp_path):
    certificate, key, _ = files
    weak = tmp_path / "token"
    weak.write_text("secret\n")
    weak.chmod(0o600)
    with pytest.raises(InputError, match="22 or more random letters"):
        outside("localhost", certificate, key, weak)
    weak.write_text(TOKEN)
    weak.chmod(0o644)
    with pytest.raises(InputError, match="others can read it"):
        outside("localhost", certificate, key, weak)
    for everywhere in ("0.0.0.0", "::"):
        with pytest.raises(InputError, match="every interface"):
            outside(everywhere, *files)
    with pytest.raises(InputError, match="not a certificate and its key"):
        outside("localhost", certificate, certificate, files[2])
    with pytest.raises(InputError, match="only together with --listen"):
        outside("", *files)


@pytest.fixture
def served(drive, files):
    with Server(drive, outside=outside("localhost", *files)) as server:
        yield server


def get(server, files, path, **headers):
    trusting = ssl.create_default_context(cafile=files[0])
    connection = http.client.HTTPSConnection("localhost", server.guard.port, timeout=5, context=trusting)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    return answer.status, answer.getheader("Set-Cookie", "")


def test_only_the_token_opens_it_and_the_cookie_is_for_encrypted_connections(served, files):
    assert served.address == f"https://localhost:{served.guard.port}/?token={TOKEN}"
    status, cookie = get(served, files, f"/?token={TOKEN}")
    assert status == 200
    assert "Secure" in cookie
    assert get(served, files, "/")[0] == 403
    assert get(served, files, "/?token=guess")[0] == 403
    assert get(served, files, f"/?token={TOKEN}", Host="evil.example")[0] == 403
    assert get(served, files, f"/?token={TOKEN}", Origin=f"http://localhost:{served.guard.port}")[0] == 403


def test_there_is_nothing_unencrypted(served):
    connection = http.client.HTTPConnection("localhost", served.guard.port, timeout=5)
    with pytest.raises((http.client.HTTPException, OSError)):
        connection.request("GET", f"/?token={TOKEN}")
        connection.getresponse()


def test_the_page_works_over_it(served, chromium):
    context = chromium.new_context(ignore_https_errors=True)
    page = context.new_page()
    page.goto(served.address)
    page.wait_for_selector("#state:has-text('ready')")
    page.wait_for_selector("[data-value=speed_reference]:has-text('rpm')")
    context.close()
