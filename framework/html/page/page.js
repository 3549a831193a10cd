// SPDX-FileCopyrightText: 2026 the petal authors
// SPDX-License-Identifier: BSD-3-Clause

// What a report's page can do beyond being read: numbers tell where they come from, the document behind them can be shown and
// saved, matrices can be copied. The page says all without it.
(function () {
  "use strict";
  const source = document.getElementById("data");
  const text = source.textContent.trim();
  const data = JSON.parse(text);

  for (const element of document.querySelectorAll("data[data-from]"))
    element.title = element.dataset.from + " = " + element.value;

  function at(pointer) {
    return pointer.split("/").slice(1).reduce(
      (value, part) => value[part.replace(/~1/g, "/").replace(/~0/g, "~")], data);
  }

  const shown = document.querySelector("#document-text pre");
  document.getElementById("document-text").addEventListener("toggle", () => {
    shown.textContent = text;
  });

  function button(label, action) {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = label;
    made.addEventListener("click", () => action(made));
    return made;
  }

  document.getElementById("document-actions").append(
    button("Save " + source.dataset.name, () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text + "\n"], { type: "application/json" }));
      link.download = source.dataset.name;
      link.click();
      URL.revokeObjectURL(link.href);
    }));

  // Pages opened from disk may not write to the clipboard by themselves; marking and copying works everywhere.
  function copy(content) {
    const field = document.createElement("textarea");
    field.value = content;
    document.body.append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    return done;
  }

  for (const place of document.querySelectorAll("[data-copy]"))
    place.append(button("Copy, all digits", (made) => {
      const rows = at(place.dataset.copy).map((row) => "[" + row.join(", ") + "]");
      const before = made.textContent;
      made.textContent = copy("[" + rows.join(",\n ") + "]\n") ? "Copied" : "Could not copy";
      made.focus();
      setTimeout(() => { made.textContent = before; }, 1500);
    }));
})();
