"""For tools/make-manual: anchors of headings as GitHub makes them, which is what the pages' links say."""
import re


def anchor(heading, _separator="-"):
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


def on_config(config):
    config["mdx_configs"].setdefault("toc", {})["slugify"] = anchor
    return config
