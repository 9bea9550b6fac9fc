// Where texts of a page cannot be read: on each other, cut off, or not there. Of pictures these are groups of outlines.
(() => {
  const told = [], box = (x) => x.getBoundingClientRect(), seen = (x) => x.checkVisibility();
  const shared = (a, b) => [
    Math.min(a.right, b.right) - Math.max(a.left, b.left),
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top),
  ];
  const onEachOther = (a, b, most) => Math.min(...shared(a, b)) > most;
  const isOutside = (a, b) =>
    a.left < b.left - 1 || a.right > b.right + 1 || a.top < b.top - 1 || a.bottom > b.bottom + 1;
  for (const svg of [...document.querySelectorAll("svg[role]")].filter(seen)) {
    const [frame, name] = [box(svg), svg.getAttribute("aria-labelledby").split(" ")[0]];
    const texts = [...svg.querySelectorAll('g[id*="text_"], text')].filter((x) => box(x).width > 0.5);
    const spoken = (x) => ([...x.childNodes].find((y) => y.nodeType === 8)?.data ?? x.textContent).trim();
    if (!texts.length) told.push(`${name}: no texts`);
    texts.forEach((text, k) => {
      if (isOutside(box(text), frame)) told.push(`${name}: '${spoken(text)}' is cut off`);
      for (const other of texts.slice(k + 1)) {
        const apart = !text.contains(other) && !other.contains(text);
        if (apart && onEachOther(box(text), box(other), 1.2 * (frame.width / svg.viewBox.baseVal.width)))
          told.push(`${name}: '${spoken(text)}' on '${spoken(other)}'`);
      }
    });
  }
  const lines = [], walker = document.createTreeWalker(document.querySelector("main"), NodeFilter.SHOW_TEXT);
  for (let node; (node = walker.nextNode()); ) {
    const [parent, range] = [node.parentElement, document.createRange()];
    if (!node.data.trim() || parent.closest("svg, script, style") || !seen(parent)) continue;
    range.selectNodeContents(node);
    for (const rect of range.getClientRects())
      if (rect.width > 1) lines.push({ rect, text: node.data.trim().slice(0, 40), wide: parent.closest(".wide") });
  }
  lines.sort((a, b) => a.rect.top - b.rect.top);
  lines.forEach(({ rect, text, wide }, k) => {
    if (!wide && (rect.right > innerWidth + 0.5 || rect.left < -0.5)) told.push(`'${text}' is cut off`);
    for (let j = k + 1; j < lines.length && lines[j].rect.top < rect.bottom; j++)
      if (onEachOther(rect, lines[j].rect, 3)) told.push(`'${text}' on '${lines[j].text}'`);
  });
  for (const x of document.querySelectorAll("p, li, h1, h2, h3, tbody th, caption, figcaption, section, figure, table"))
    if (seen(x) && !x.querySelector("svg") && !x.textContent.trim()) told.push(`${x.outerHTML.slice(0, 60)} is empty`);
  return told;
})()
