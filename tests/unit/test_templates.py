import re
from pathlib import Path

import jinja2
import pytest

from scanplan.report import templates

PAGES = Path(__file__).resolve().parents[2] / "workflow/report/page"


def test_text_is_escaped_and_files_are_put_in_as_they_are():
    sources = {"a.j2": '<p>{{ text }}</p>{{ file("b.css") }}\n', "b.css": "a > b {}"}
    page = templates.render_template(sources, "a.j2", text="<b> & c")
    assert page == "<p>&lt;b&gt; &amp; c</p>a > b {}\n"


def test_a_placeholder_without_a_value_is_refused():
    with pytest.raises(jinja2.UndefinedError, match="txet"):
        templates.render_template({"a.j2": "{{ txet }}"}, "a.j2", text="b")


def test_what_is_no_input_cannot_be_used():
    with pytest.raises(jinja2.TemplateNotFound, match=r"b\.j2"):
        templates.render_template({"a.j2": '{% include "b.j2" %}'}, "a.j2")


def test_data_for_scripts_is_json_that_ends_no_script():
    page = templates.render_template({"a.j2": "{{ data | tojson }}"}, "a.j2", data=["</script>"])
    assert "<" not in page
    with pytest.raises(ValueError, match="not JSON compliant"):
        templates.render_template({"a.j2": "{{ data | tojson }}"}, "a.j2", data=[float("nan")])


def test_every_file_of_the_pages_is_an_input_of_a_page(project_root):
    rules = "".join(file.read_text() for file in (project_root / "workflow/rules").glob("*.smk"))
    listed = re.findall(r'"([\w.]+\.(?:j2|css|js))"', rules)
    assert set(listed) == {file.name for file in PAGES.iterdir()}
