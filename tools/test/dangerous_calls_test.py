# SPDX-License-Identifier: BSD-3-Clause
"""No reader of a file can execute code from it (docs/security.md)."""
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Calls that execute what a file contains, or hand a text to a shell.
DANGEROUS = re.compile(
    r"torch::load|torch::jit|torch\.load\(|pickle\.loads?\(|\byaml\.(?:full_|unsafe_)?load\("
    r"|shell=True|os\.system\(|os\.popen\(|std::system\(|[^\w:.]popen\(|dlopen\("
    r"|(?<![\w.])eval\(|(?<![\w.])exec\(")

# Sources that load a library that the user names, or read what they have written themselves.
ALLOWED = {"aquafarm_agents/core/src/training/register_learner.cpp": "dlopen(",
           "tools/python_checks/gymnasium_envs.py": "pickle.loads(pickle.dumps(env))"}


def sources():
    """Yields (name, text) of the tracked programs outside the folders test, docs and bench."""
    names = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, check=True,
                           text=True).stdout.split("\0")
    for name in names:
        path = ROOT / name
        parts = pathlib.PurePath(name).parts
        if {"test", "docs", "bench"} & set(parts) or not path.is_file():
            continue
        is_script = not path.suffix and path.read_bytes()[:2] == b"#!"
        if path.suffix in (".cpp", ".h", ".py") or is_script:
            yield name, path.read_text()


def test_no_source_executes_what_it_reads():
    found = []
    count = 0
    for name, text in sources():
        count += 1
        for number, line in enumerate(text.splitlines(), 1):
            allowed = name in ALLOWED and ALLOWED[name] in line
            if DANGEROUS.search(line) and not allowed:
                found.append(f"{name}:{number}: {line.strip()}")
    assert count > 300
    assert not found, "\n".join(found)


def test_the_pattern_finds_what_it_should():
    for line in ("torch::load(net, path)", "data = pickle.loads(text)", "yaml.load(text)",
                 "run(words, shell=True)", "value = eval(text)", "system = std::system(words)"):
        assert DANGEROUS.search(line), line
    for line in ("yaml.safe_load(text)", "parser.Eval()", "model.eval()", "values = my_eval(x)"):
        assert not DANGEROUS.search(line), line
