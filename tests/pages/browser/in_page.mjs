// What is looked for inside a page; each function runs there, by itself, and returns sentences.

/** Labels of figures that reach beyond their drawing. */
export function cutLabels() {
  const faults = [];
  for (const svg of document.querySelectorAll(".plot svg")) {
    const frame = svg.getBoundingClientRect();
    if (frame.width === 0) continue;
    const name = svg.closest("[aria-label]").getAttribute("aria-label");
    for (const text of svg.querySelectorAll("text")) {
      const box = text.getBoundingClientRect();
      const isCut =
        box.left < frame.left - 1 ||
        box.right > frame.right + 1 ||
        box.top < frame.top - 3 ||
        box.bottom > frame.bottom + 3;
      if (isCut) {
        faults.push(`label "${text.textContent}" is cut in ${name}`);
      }
    }
  }
  return faults;
}

/** Labels of one figure that lie over each other. */
export function overlappingLabels() {
  const faults = [];
  for (const svg of document.querySelectorAll(".plot svg")) {
    if (svg.getBoundingClientRect().width === 0) continue;
    const name = svg.closest("[aria-label]").getAttribute("aria-label");
    const texts = [...svg.querySelectorAll("text")]
      .filter((text) => text.textContent.trim() !== "")
      .map((text) => ({ words: text.textContent, box: text.getBoundingClientRect() }));
    texts.forEach((a, i) => {
      for (const b of texts.slice(i + 1)) {
        const across = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const down = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
        const low = Math.min(a.box.height, b.box.height);
        if (across > 1 && down > 0.4 * low) {
          faults.push(
            `"${a.words}" lies over "${b.words}" in ${name}`,
          );
        }
      }
    });
  }
  return faults;
}

/** Tables that need scrolling sideways even in a wide window; those that a figure folds away may. */
export function wideTables() {
  return [...document.querySelectorAll("table")]
    .filter((table) => !table.closest("details"))
    .filter((table) => table.parentElement.scrollWidth > table.parentElement.clientWidth + 1)
    .map((table) => {
      const name = table.parentElement.getAttribute("aria-label") ?? "a table";
      return `"${name}" is ${table.scrollWidth} px wide, its place ${table.parentElement.clientWidth}`;
    });
}

/** Rows are alike, and axe-core looks at each cell: thousands of days would take it minutes. */
export function keepFirstRows() {
  for (const row of document.querySelectorAll("tbody tr:nth-child(n+16)")) row.remove();
}
