"""Formulas of the theory pages as KaTeX: signs, brackets, products, columns; all pages come through with their braces closed."""

import html
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from typeset import column, sentence, typeset  # noqa: E402


def tex(text):
    return re.sub(r"\s+", " ", column(text)[0]).replace(" }", "}").replace("} ", "}").strip()


class Formulas(unittest.TestCase):
    def test_signs_functions_and_indices(self):
        self.assertEqual(tex("sigma <= f_t (2r - r^2)"), r"\sigma \le f_{t}(2r - r ^{2})")
        self.assertEqual(tex("(e/e_s)^(1/3) + sqrt(1 + xi^2)"), r"(e /e_{s})^{1/3}+ \sqrt{1 + \xi ^{2}}")
        self.assertEqual(tex("a^delta"), r"a ^{\delta}")
        self.assertEqual(tex("nu'^2 E/E'^2"), r"{\nu'}^{2}E /{E'}^{2}")

    def test_angles_are_brackets_and_x_a_product_between_factors(self):
        self.assertEqual(tex("<o - o_p>/o_t <= 1"), r"\langle o - o_{p}\rangle /o_{t}\le 1")
        self.assertEqual(tex("(m_1 - m_0) x (m_2 - m_0)"), r"(m_{1}- m_{0}) \times (m_{2}- m_{0})")
        self.assertEqual(tex("(1 - x)/5 + x (1/3)"), r"(1 - x )/5 + x (1/3)")
        self.assertEqual(tex("a . b"), r"a \cdot b")
        self.assertEqual(tex("D - v.n"), r"D - v \cdot n")

    def test_sentences_stay_text(self):
        self.assertTrue(tex("from b into a, of the middle surface").startswith(r"\text{from b into a}"))
        self.assertIn(r"\texttt{opening\_of}", column("`opening_of`")[0])

    def test_symbols_of_sentences_have_indices_and_powers(self):
        self.assertEqual(sentence("with R_a, rho_s L^2/12 and **x**_b"), "with <i>R</i><sub>a</sub>, <i>ρ</i><sub>s</sub> L<sup>2</sup>/12 and **x**<sub>b</sub>")
        self.assertEqual(sentence("(nu - 1)^(1/3)"), "(<i>ν</i> - 1)<sup>1/3</sup>")
        self.assertEqual(sentence("E/rho^theta"), "E/<i>ρ</i><sup><i>θ</i></sup>")
        for same in ("`f_t` in [x](a_b.md#c_d)", "rock_force and dem/d_e.hpp", "a numerical alphabet"):
            self.assertEqual(sentence(same), same)

    def test_pages_keep_what_is_no_formula(self):
        self.assertEqual(typeset("```\n\n    a = b\n```\n"), "```\n\n    a = b\n```\n")
        self.assertEqual(typeset("a list\n\n    only words stand here\n"), "a list\n\n    only words stand here\n")
        page = typeset("text\n\n    a = b < c      words\n\nmore")
        self.assertIn(r"\[\begin{array}{ll}", page)
        self.assertIn("b &lt; c", page.replace("  ", " "))

    def test_every_block_closes(self):
        count = 0
        for page in sorted((ROOT / "docs").glob("theory*.md")):
            for found in re.findall(r'<div class="equation">\n(.*?)\n</div>', typeset(page.read_text()), re.DOTALL):
                text = html.unescape(found).replace(r"\{", "").replace(r"\}", "")
                self.assertEqual(text.count("{"), text.count("}"), found)
                self.assertNotIn("<", re.sub(r"&\w+;", "", found))
                count += 1
        self.assertGreater(count, 20)


if __name__ == "__main__":
    unittest.main()
