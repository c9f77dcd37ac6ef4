"use strict";
(() => {
  const root = document.documentElement;

  // Theme: that of the system, light or dark.
  const themes = ["system", "light", "dark"];
  const button = document.getElementById("theme");
  const show = (theme) => {
    if (theme === "system") delete root.dataset.theme;
    else root.dataset.theme = theme;
    button.textContent = `Theme: ${theme}`;
  };
  const kept = () => {
    // Pages from files may have no storage.
    try { return localStorage.getItem("npr-theme"); } catch { return null; }
  };
  let theme = themes.includes(kept()) ? kept() : "system";
  show(theme);
  button.addEventListener("click", () => {
    theme = themes[(themes.indexOf(theme) + 1) % themes.length];
    show(theme);
    try { localStorage.setItem("npr-theme", theme); } catch { /* it is forgotten */ }
  });

  // Points of charts: a tooltip with their numbers, and arrow keys.
  const tip = document.getElementById("tip");
  const hide = () => { tip.hidden = true; };
  const explain = (mark) => {
    tip.replaceChildren();
    const name = document.createElement("strong");
    name.textContent = mark.dataset.name;
    const list = document.createElement("dl");
    for (const line of mark.dataset.tip.split("\n")) {
      const [term, value] = line.split("\t");
      const dt = document.createElement("dt");
      const dd = document.createElement("dd");
      dt.textContent = term;
      dd.textContent = value;
      list.append(dt, dd);
    }
    tip.append(name, list);
    tip.hidden = false;
    const at = mark.getBoundingClientRect();
    const own = tip.getBoundingClientRect();
    const left = Math.min(Math.max(at.left + at.width / 2 - own.width / 2, 8), root.clientWidth - own.width - 8);
    const above = at.top - own.height - 6;
    tip.style.left = `${Math.max(left, 8)}px`;
    tip.style.top = `${above >= 8 ? above : at.bottom + 6}px`;
  };
  for (const diagram of document.querySelectorAll(".diagram")) {
    const marks = [...diagram.querySelectorAll(".mark")];
    marks.forEach((mark, number) => {
      mark.addEventListener("pointerenter", () => explain(mark));
      mark.addEventListener("pointerleave", hide);
      mark.addEventListener("focus", () => explain(mark));
      mark.addEventListener("blur", hide);
      mark.addEventListener("keydown", (event) => {
        const steps = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };
        let next;
        if (event.key in steps) next = number + steps[event.key];
        else if (event.key === "Home") next = 0;
        else if (event.key === "End") next = marks.length - 1;
        else if (event.key === "Escape") return hide();
        else return;
        event.preventDefault();
        next = Math.min(Math.max(next, 0), marks.length - 1);
        mark.setAttribute("tabindex", "-1");
        marks[next].setAttribute("tabindex", "0");
        marks[next].focus();
      });
    });
  }
  addEventListener("scroll", () => {
    if (!(document.activeElement && document.activeElement.classList.contains("mark"))) hide();
    else explain(document.activeElement);
  }, { passive: true });

  // Tables: sorted by the column whose heading is pressed, then the other way.
  const value = (row, column, isNumber) => {
    const cell = row.cells[column];
    if (!isNumber) return cell.textContent;
    return "value" in cell.dataset ? Number(cell.dataset.value) : NaN;
  };
  for (const table of document.querySelectorAll("table.sortable")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      head.firstElementChild.addEventListener("click", () => {
        const descending = head.getAttribute("aria-sort") === "ascending";
        const isNumber = head.classList.contains("number");
        for (const other of heads) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", descending ? "descending" : "ascending");
        const body = table.tBodies[0];
        const order = (a, b) => {
          const [x, y] = [value(a, column, isNumber), value(b, column, isNumber)];
          if (!isNumber) return descending ? y.localeCompare(x) : x.localeCompare(y);
          // What has no number is last, either way.
          if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y);
          return descending ? y - x : x - y;
        };
        body.append(...[...body.rows].sort(order));
      });
    });
  }

  // Filters of the table of checks.
  for (const filter of document.querySelectorAll(".filter")) {
    const text = filter.querySelector("[data-filter]");
    const failed = filter.querySelector("[data-failed]");
    const said = filter.querySelector("output");
    const rows = [...document.getElementById(text.dataset.filter).tBodies[0].rows];
    const apply = () => {
      const words = text.value.toLowerCase().split(/\s+/);
      let shown = 0;
      for (const row of rows) {
        const content = row.textContent.toLowerCase();
        const fits = words.every((word) => content.includes(word)) && (!failed.checked || row.classList.contains("failed"));
        row.hidden = !fits;
        shown += fits ? 1 : 0;
      }
      said.textContent = `${shown} of ${rows.length}`;
    };
    text.addEventListener("input", apply);
    failed.addEventListener("change", apply);
    apply();
  }

  // Two pictures with a border between them.
  for (const slider of document.querySelectorAll(".slider input")) {
    const compare = slider.closest("figure").querySelector(".compare");
    slider.addEventListener("input", () => compare.style.setProperty("--split", `${slider.value}%`));
    compare.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" && event.buttons === 0) return;
      const area = compare.getBoundingClientRect();
      slider.value = (100 * (event.clientX - area.left)) / area.width;
      compare.style.setProperty("--split", `${slider.value}%`);
    });
  }
})();
