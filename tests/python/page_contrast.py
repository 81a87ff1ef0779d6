"""What a browser shows, measured: contrast of texts and of controls' edges (WCAG 2.2, 1.4.3 and 1.4.11)."""

TEXT, LINE = 4.5, 3.0

LUMINANCE = """
const parts = (colour) => {
    const [r, g, b, a = 1] = colour.match(/[\\d.]+/g).map(Number);
    return colour.startsWith('color(') ? [r * 255, g * 255, b * 255, a] : [r, g, b, a];
};
const over = (top, below) => [0, 1, 2].map((k) => top[k] * top[3] + below[k] * (1 - top[3])).concat(1);
const ground = (element) => {
    const stack = [];
    for (let at = element; at; at = at.parentElement) stack.push(parts(getComputedStyle(at).backgroundColor));
    return stack.reverse().reduce((below, top) => over(top, below), [255, 255, 255, 1]);
};
const faded = (element) => {
    let share = 1;
    for (let at = element; at; at = at.parentElement) share *= Number(getComputedStyle(at).opacity);
    return share;
};
const luminance = (colour) => {
    const [r, g, b] = colour.map((x) => x / 255).map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const contrast = (one, other) => {
    const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
};
const shown = (element) => element.checkVisibility() && !element.closest('option') && !element.closest(':disabled');
"""

_TEXTS = (
    "() => {"
    + LUMINANCE
    + """
    const found = [];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walk.nextNode(); node; node = walk.nextNode()) {
        const element = node.parentElement;
        if (!node.textContent.trim() || !shown(element)) continue;
        const below = ground(element);
        const ink = parts(getComputedStyle(element).color);
        ink[3] *= faded(element);
        found.push([node.textContent.trim().slice(0, 40), contrast(over(ink, below), below)]);
    }
    return found;
}"""
)

_EDGES = (
    "() => {"
    + LUMINANCE
    + """
    const found = [];
    const fields = 'input:not([type=checkbox], [type=range]), select, button, .button';
    for (const element of document.querySelectorAll(fields)) {
        if (!shown(element) || element.getAttribute('role') === 'tab' || element.classList.contains('back')) continue;
        const around = ground(element.parentElement);
        const style = getComputedStyle(element);
        const own = over(parts(style.backgroundColor), around);
        const edge = over(parts(style.borderTopColor), around);
        found.push([element.id || element.textContent, Math.max(contrast(own, around), contrast(edge, around))]);
    }
    return found;
}"""
)

_COLOURS = (
    "() => {"
    + LUMINANCE
    + """
    const probe = document.body.appendChild(document.createElement('i'));
    const colour = (name) => { probe.style.color = `var(${name})`; return parts(getComputedStyle(probe).color); };
    const card = colour('--card');
    const found = Object.fromEntries(['--ink', '--quiet', ...Array.from({length: 8}, (_, k) => `--line-${k + 1}`)]
        .map((name) => [name, contrast(colour(name), card)]));
    probe.remove();
    return found;
}"""
)


def pale_texts(page):
    """(text, contrast) of what is not readable; what is disabled need not be."""
    texts = page.evaluate(_TEXTS)
    assert len(texts) > 20
    return [(text, round(value, 2)) for text, value in texts if value < TEXT]


def pale_edges(page):
    """The same of the edges of fields and buttons."""
    edges = page.evaluate(_EDGES)
    assert len(edges) > 3
    return [(text, round(value, 2)) for text, value in edges if value < LINE]


def canvas_colours(page):
    """Contrast with the card of what is drawn: texts by --ink and --quiet, lines by --line-1 to --line-8."""
    return page.evaluate(_COLOURS)
