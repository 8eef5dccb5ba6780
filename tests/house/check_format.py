"""Names the C++ files that clang-format would change. Usage: check_format.py CLANG_FORMAT ROOT"""
import subprocess
import sys

from check_layout import source_files

clang_format, root = sys.argv[1:]
paths = [str(path) for path in source_files(root, {".cpp", ".hpp"})]
result = subprocess.run([clang_format, "--dry-run", "--Werror", *paths], stderr=subprocess.PIPE, text=True)
if result.returncode:
    bad = sorted({line.split(":")[0] for line in result.stderr.splitlines() if "error:" in line})
    print("Not formatted; run: clang-format -i " + " ".join(bad) if bad else result.stderr)
sys.exit(result.returncode)
