// Put at the end of the page: looks at it, and tells the page around it what is wrong.
window.addEventListener("load", () => {
  const expect = (holds, what) => { if (!holds) findings.push(what); };
  const root = document.documentElement;
  const name = (element) => element.outerHTML.slice(0, 80);

  // Nothing is wider than the window, apart from what scrolls in a box of its own.
  expect(root.scrollWidth <= root.clientWidth, `the page is ${root.scrollWidth} px wide, the window ${root.clientWidth}`);
  for (const element of document.body.querySelectorAll("main *, header *, nav *")) {
    if (element.closest(".scroll *, .diagram *, .skip")) continue;
    const area = element.getBoundingClientRect();
    expect(area.right <= root.clientWidth + 0.5 || area.width === 0, `leaves the window: ${name(element)}`);
  }
  for (const image of document.images) {
    expect(image.naturalWidth > 0, `no picture: ${name(image)}`);
    expect(image.alt.length > 0, `no text in place of a picture: ${name(image)}`);
  }
  for (const element of document.querySelectorAll("[src], [href]")) {
    const address = element.getAttribute("src") ?? element.getAttribute("href");
    if (address.startsWith("#")) expect(document.getElementById(address.slice(1)), `leads nowhere: ${name(element)}`);
    else expect(address.startsWith("data:image/png;base64,"), `from elsewhere: ${name(element)}`);
  }
  const ids = [...document.querySelectorAll("[id]")].map((element) => element.id);
  expect(new Set(ids).size === ids.length, "two elements have one id");
  const levels = [...document.querySelectorAll("h1, h2, h3, h4")].map((heading) => Number(heading.tagName[1]));
  levels.forEach((level, n) => expect(n === 0 || level <= levels[n - 1] + 1, `heading ${n} skips a level`));
  for (const section of document.querySelectorAll("main > section")) {
    expect(document.querySelector(`nav a[href="#${section.id}"]`), `not in the contents: ${section.id}`);
  }

  // Points of charts: reached by keyboard, and explained.
  const tip = document.getElementById("tip");
  const press = (element, key) => element.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
  for (const diagram of document.querySelectorAll(".diagram")) {
    const marks = [...diagram.querySelectorAll(".mark")];
    if (marks.length === 0) continue;
    expect(marks.filter((mark) => mark.getAttribute("tabindex") === "0").length === 1, "a chart has one point for Tab");
    marks[0].focus();
    expect(document.activeElement === marks[0], "a point cannot be focused");
    for (let n = 0; n < marks.length; n += 1) {
      expect(document.activeElement === marks[n], `an arrow key does not reach point ${n}`);
      expect(!tip.hidden && tip.textContent.includes(marks[n].dataset.name), `no tooltip at point ${n}`);
      for (const word of ["executor", "relative time", "memory"]) {
        expect(tip.textContent.includes(word), `the tooltip of point ${n} lacks ${word}`);
      }
      const area = tip.getBoundingClientRect();
      expect(area.left >= 0 && area.right <= root.clientWidth, `the tooltip of point ${n} leaves the window`);
      if (n + 1 < marks.length) press(marks[n], "ArrowRight");
    }
    press(document.activeElement, "Home");
    expect(document.activeElement === marks[0], "Home does not lead to the first point");
    press(marks[0], "Escape");
    expect(tip.hidden, "Escape does not close the tooltip");
    marks[0].dispatchEvent(new PointerEvent("pointerenter"));
    expect(!tip.hidden, "no tooltip under the pointer");
    marks[0].dispatchEvent(new PointerEvent("pointerleave"));
    expect(tip.hidden, "the tooltip stays");
  }

  // Tables are sorted by number, in both directions.
  let sorted = 0;
  for (const table of document.querySelectorAll("table.sortable")) {
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      if (!head.classList.contains("number")) return;
      const values = () => [...table.tBodies[0].rows]
        .map((row) => row.cells[column].dataset.value)
        .filter((value) => value !== undefined && value !== "NaN")
        .map(Number);
      const ascending = (numbers) => numbers.every((value, n) => n === 0 || numbers[n - 1] <= value);
      head.querySelector("button").click();
      expect(head.getAttribute("aria-sort") === "ascending" && ascending(values()), `not sorted: ${table.id}, ${column}`);
      head.querySelector("button").click();
      expect(head.getAttribute("aria-sort") === "descending" && ascending(values().reverse()), `not reversed: ${table.id}`);
      sorted += 1;
    });
  }
  expect(sorted > 0, "no table was sorted");

  // The filter of the checks.
  const filter = document.querySelector("[data-filter]");
  const rows = [...document.getElementById("table-check").tBodies[0].rows];
  const shown = () => rows.filter((row) => !row.hidden);
  const failing = rows.filter((row) => row.classList.contains("failed")).length;
  const box = document.querySelector("[data-failed]");
  box.click();
  expect(shown().length === failing && failing > 0, "failed checks alone are not shown");
  box.click();
  filter.value = "no such check";
  filter.dispatchEvent(new Event("input"));
  expect(shown().length === 0, "the filter lets everything through");
  filter.value = "";
  filter.dispatchEvent(new Event("input"));
  expect(shown().length === rows.length, "the filter keeps something back");

  // The border between two pictures.
  for (const slider of document.querySelectorAll(".slider input")) {
    const compare = slider.closest("figure").querySelector(".compare");
    slider.value = 20;
    slider.dispatchEvent(new Event("input"));
    const clip = getComputedStyle(compare.querySelectorAll("img")[1]).clipPath;
    expect(clip.includes("20%"), `the slider does not move the border: ${clip}`);
  }

  // Both themes; text against its ground has the contrast of WCAG 2.1 AA.
  const channels = (color) => {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("2d");
    context.fillStyle = color;
    context.fillRect(0, 0, 1, 1);
    return [...context.getImageData(0, 0, 1, 1).data];
  };
  const luminance = (color) => {
    const [r, g, b] = channels(color).map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ground = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const color = getComputedStyle(at).backgroundColor;
      if (channels(color)[3] === 255) return color;
    }
    return "white";
  };
  const grounds = new Set();
  for (let n = 0; n < 3; n += 1) {
    document.getElementById("theme").click();
    grounds.add(getComputedStyle(document.body).backgroundColor);
    const seen = new Set();
    for (const element of document.querySelectorAll("body *")) {
      if (![...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim())) continue;
      if (element.closest("script")) continue;
      const style = getComputedStyle(element);
      const [ink, paper] = [element.closest("svg") ? style.fill : style.color, ground(element)];
      if (seen.has(ink + paper)) continue;
      seen.add(ink + paper);
      const [a, b] = [luminance(ink), luminance(paper)];
      const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      expect(contrast >= 4.5, `contrast ${contrast.toFixed(2)} in theme ${root.dataset.theme}: ${name(element)}`);
    }
  }
  expect(grounds.size === 2, `the theme does not change: ${[...grounds].join(", ")}`);

  const marks = document.querySelectorAll(".mark").length;
  parent.postMessage(JSON.stringify({ width: innerWidth, marks, findings }), "*");
});
