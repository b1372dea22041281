"""A mail server and a web server on this machine that write down what they are sent.

  message_sink.py FOLDER [--tls CERT KEY] [--auth USER PASSWORD] [--refuse N]

Prints "mail PORT web PORT" once both listen. Each message is a JSON file in FOLDER, numbered in
order of arrival over both: {"by": "mail", "from", "to", "subject", "id", "text"} as Python's own
parser reads it, or {"by": "web", "path", "authorization", "headers", "body"}, the body in
hexadecimal digits unless it is JSON. Of web requests the first N get a 503; /moved is redirected to
/elsewhere; /busy gets a 429 with Retry-After and a long text; /slow is never answered.
"""

import argparse
import asyncio
import email
import email.policy
import http.server
import itertools
import json
import pathlib
import ssl
import threading
import time

from aiosmtpd.smtp import SMTP, AuthResult

options = argparse.ArgumentParser()
options.add_argument("folder", type=pathlib.Path)
options.add_argument("--tls", nargs=2)
options.add_argument("--auth", nargs=2)
options.add_argument("--refuse", type=int, default=0)
options = options.parse_args()
numbers = itertools.count(1)
lock = threading.Lock()


def write_down(message):
    with lock:
        name = f"{next(numbers):03}"
        unfinished = options.folder / (name + ".part")
        unfinished.write_text(json.dumps(message))
        unfinished.rename(options.folder / (name + ".json"))


class MailHandler:
    async def handle_DATA(self, server, session, envelope):
        mail = email.message_from_bytes(envelope.content, policy=email.policy.default)
        write_down(
            {
                "by": "mail",
                "from": envelope.mail_from,
                "to": envelope.rcpt_tos,
                "subject": mail["subject"],
                "id": mail["message-id"],
                "text": mail.get_content(),
            }
        )
        return "250 OK"


def authenticate(server, session, envelope, mechanism, data):
    given = [data.login.decode(), data.password.decode()]
    return AuthResult(success=given == options.auth, handled=False)


def mail_session():
    context = None
    if options.tls:
        context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
        context.load_cert_chain(*options.tls)
    return SMTP(
        MailHandler(),
        hostname="localhost",
        tls_context=context,
        require_starttls=context is not None,
        authenticator=authenticate if options.auth else None,
        auth_required=options.auth is not None,
        enable_SMTPUTF8=True,
    )


class WebHandler(http.server.BaseHTTPRequestHandler):
    refusals = options.refuse

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.path == "/slow":
            time.sleep(3600)
        is_json = self.headers["Content-Type"] == "application/json"
        status = 200
        with lock:
            if WebHandler.refusals > 0:
                WebHandler.refusals -= 1
                status = 503
        if self.path == "/moved":
            status = 302
        if self.path == "/busy":
            status = 429
        if status == 200:
            write_down(
                {
                    "by": "web",
                    "path": self.path,
                    "authorization": self.headers.get("Authorization"),
                    "headers": dict(self.headers),
                    "body": json.loads(body) if is_json else body.hex(),
                }
            )
        self.send_response(status)
        if status == 302:
            self.send_header("Location", "/elsewhere")
        answer = b""
        if status == 429:
            self.send_header("Retry-After", "120")
            answer = b"too many: " + 10000 * b"."
        self.send_header("Content-Length", str(len(answer)))
        self.end_headers()
        self.wfile.write(answer)

    def log_message(self, *_):
        pass


async def main():
    web = http.server.ThreadingHTTPServer(("127.0.0.1", 0), WebHandler)
    web.daemon_threads = True
    threading.Thread(target=web.serve_forever, daemon=True).start()
    mail = await asyncio.get_running_loop().create_server(mail_session, "127.0.0.1", 0)
    print("mail", mail.sockets[0].getsockname()[1], "web", web.server_port, flush=True)
    await mail.serve_forever()


asyncio.run(main())
