#!/usr/bin/env python3
"""The server of `watch --serve`: to whom it answers, and what with."""

import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ["BRECCIA"]
CASES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "cases")


class Serving(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = os.path.join(cls.scratch.name, "run")
        subprocess.run([PROGRAM, "run", f"{CASES}/rc_slab/small.toml", "-o", cls.folder, "-q", "--threads", "1", "--steps", "40",
                        "--set", "output.frames=20", "--set", "output.pictures=false"], check=True)
        cls.server = subprocess.Popen([PROGRAM, "watch", cls.folder, "--serve"], stdout=subprocess.PIPE, text=True)
        cls.address = cls.server.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})$", cls.address.strip())
        cls.port, cls.token = int(found[1]), found[2]

    @classmethod
    def tearDownClass(cls):
        cls.server.send_signal(signal.SIGINT)
        cls.code = cls.server.wait(20)
        cls.server.stdout.close()
        cls.scratch.cleanup()

    def ask(self, path, host=None, method="GET"):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.putrequest(method, path, skip_host=True)
        connection.putheader("Host", host or f"127.0.0.1:{self.port}")
        if method in ("POST", "PUT"):
            connection.putheader("Content-Length", "0")  # without it the server waits 5 s for a body
        connection.endheaders()
        answer = connection.getresponse()
        body = answer.read().decode()
        connection.close()
        return answer, body

    def test_the_page_is_the_report_of_the_folder_as_it_is_now(self):
        answer, body = self.ask(f"/?token={self.token}")
        self.assertEqual(answer.status, 200)
        self.assertIn("breccia report</title>", body)
        self.assertIn('"live":{', body)
        self.assertIn("connect-src 'self'", body)
        self.assertEqual(answer.headers["Cache-Control"], "no-store")
        self.assertEqual(answer.headers["X-Frame-Options"], "DENY")

    def test_the_state_is_that_of_the_summary(self):
        answer, body = self.ask(f"/state?token={self.token}")
        state = json.loads(body)
        with open(f"{self.folder}/summary.json") as file:
            summary = json.load(file)
        self.assertEqual((answer.status, state["status"], state["step"]), (200, "done", summary["steps"]))
        self.assertGreaterEqual(state["frames"], 1)

    def test_nobody_gets_in_without_the_token(self):
        for path in ("/", "/state", "/?token=", "/?token=" + "0" * 32, "/?token=" + self.token[:-1],
                     "/?token=" + self.token + "0", "/state?Token=" + self.token):
            answer, body = self.ask(path)
            self.assertEqual(answer.status, 403, path)
            self.assertNotIn("live", body)

    def test_a_name_of_another_site_is_refused(self):
        for host in ("evil.example", f"evil.example:{self.port}", "127.0.0.1", f"127.0.0.1:{self.port + 1}"):
            self.assertEqual(self.ask(f"/?token={self.token}", host)[0].status, 403, host)
        self.assertEqual(self.ask(f"/?token={self.token}", f"localhost:{self.port}")[0].status, 200)

    def test_no_path_names_a_file(self):
        for path in ("/summary.json", "/../summary.json", "/..%2f..%2fetc/passwd", "//etc/passwd", "/fields/", "/state/..", "/%00"):
            answer, body = self.ask(f"{path}?token={self.token}")
            self.assertIn(answer.status, (400, 404), path)
            self.assertNotIn("root:", body)
        for method in ("POST", "PUT", "DELETE", "OPTIONS"):
            self.assertGreaterEqual(self.ask(f"/?token={self.token}", method=method)[0].status, 400)

    def test_it_listens_on_loopback_alone(self):
        listening = []
        for table in ("/proc/net/tcp", "/proc/net/tcp6"):
            with open(table) as file:
                for line in file.readlines()[1:]:
                    local, state = line.split()[1], line.split()[3]
                    if state == "0A" and int(local.rsplit(":", 1)[1], 16) == self.port:
                        listening.append(local.split(":")[0])
        self.assertEqual(listening, ["0100007F"])

    def test_a_port_that_is_taken_is_told(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            done = subprocess.run([PROGRAM, "watch", self.folder, "--serve", "--port", str(taken.getsockname()[1])],
                                  capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 3)
        self.assertIn("leave --port out", done.stderr)


if __name__ == "__main__":
    sys.exit(unittest.main())
