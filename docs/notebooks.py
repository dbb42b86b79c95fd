"""From a notebook to a page of the site.

It is run while the site is built, so that the page shows what happens, and no output is kept beside the source.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from nbconvert import MarkdownExporter
from nbconvert.preprocessors import ExecutePreprocessor
from traitlets.config import Config

OFFER = "[This page as a notebook]({name}), to run and to change."


def on_files(files: Files, config: MkDocsConfig) -> None:
    """Add a page for every notebook, of the same name, and its pictures."""
    for notebook in [file for file in files if file.src_uri.endswith(".ipynb")]:
        body, pictures = page(Path(config.docs_dir, notebook.src_uri))
        title, _, rest = body.lstrip().partition("\n")
        text = f"{title}\n\n{OFFER.format(name=Path(notebook.src_uri).name)}\n{rest}"
        files.append(File.generated(config, notebook.src_uri.replace(".ipynb", ".md"), content=text))
        for name, content in pictures.items():
            files.append(File.generated(config, name, content=content))


def page(path: Path) -> tuple[str, dict[str, bytes]]:
    """Run a notebook and give it as Markdown, with its pictures by name; an error of a cell ends the build."""
    notebook = nbformat.read(path, as_version=4)
    with TemporaryDirectory() as folder:
        # Sockets in a folder of our own, to which nobody else on the machine listens.
        sockets = Config(KernelManager={"transport": "ipc", "ip": f"{folder}/kernel"})
        ExecutePreprocessor(timeout=300, config=sockets).preprocess(notebook, {"metadata": {"path": folder}})
    names = {"unique_key": path.stem, "output_files_dir": f"{path.stem}_files"}
    body, resources = MarkdownExporter().from_notebook_node(notebook, names)
    return body, resources["outputs"]
