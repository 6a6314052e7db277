# SPDX-License-Identifier: LGPL-2.1-or-later
"""Output of the program to a terminal: it is run in one."""

import fcntl
import os
import pty
import struct
import tempfile
import termios
import unittest
from pathlib import Path

CASE = """
[case]
name = "a-case-with-a-name-that-is-long-for-a-line"
[cilium]
diameter = "3 mm"
segment = [
  { name = "base", length = "3 mm", young_modulus = "0.1 MPa", poisson_ratio = 0.49 },
  { name = "magnet", length = "17 mm", young_modulus = "3 MPa", poisson_ratio = 0.49, magnetization = "75 kA/m" },
]
[load]
type = "contact"
force = ["1 mN", "2 mN", "3 mN", "4 mN"]
height = "16 mm"
[models]
mechanics = ["beam", "solid"]
"""


def in_terminal(columns, arguments):
    """Output of the program to a terminal of so many columns, and its exit code."""
    process, terminal = pty.fork()
    if process == 0:
        fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        os.execv(os.environ["CILIAVAL_PROGRAM"], ["ciliaval", *arguments])
    text = b""
    while True:
        try:
            read = os.read(terminal, 4096)
        except OSError:  # the other end is closed
            break
        if not read:
            break
        text += read
    os.close(terminal)
    return text.decode(), os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


class ProgressLine(unittest.TestCase):
    def test_fits_into_the_terminal(self):
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "case.toml"
            case.write_text(CASE)
            text, code = in_terminal(50, ["run", str(case), "-o", folder])
        self.assertEqual(code, 0, text)
        lines = text.split("\r\033[K")[1:]
        overwritten = [line for line in lines[:-1] if line and not line.endswith("\n")]
        self.assertTrue(overwritten, text)
        for line in overwritten:
            self.assertLess(len(line), 50)
            self.assertRegex(line, r"\(.*\d s.*\)$")  # the times stay
        self.assertNotIn("about 0 s", text)


if __name__ == "__main__":
    unittest.main()
