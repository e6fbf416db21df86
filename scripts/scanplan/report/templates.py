"""Filling in the templates of the pages, which lie in workflow/report/page."""

from collections.abc import Mapping

import jinja2
from markupsafe import Markup


def render_template(sources: Mapping[str, str], template: str, /, **values: object) -> str:
    """Fill in a template; text is escaped, what is `Markup` already stays as it is.

    Parameters
    ----------
    sources : dict of str to str
        File name to text: all that the page is made from. `{{ file("page.css") }}` puts one in as
        it is.
    template : str
        File name of the one to fill in.
    **values
        What its placeholders stand for.

    Returns
    -------
    str

    Raises
    ------
    jinja2.UndefinedError
        If a placeholder has no value.
    jinja2.TemplateNotFound
        If the template asks for another one that is not among the sources.
    """
    environment = jinja2.Environment(
        loader=jinja2.DictLoader(sources),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    # JSON knows no NaN: a script could not read it
    environment.policies["json.dumps_kwargs"] = {"allow_nan": False}
    environment.globals["file"] = lambda source: Markup(sources[source])
    return environment.get_template(template).render(values)
