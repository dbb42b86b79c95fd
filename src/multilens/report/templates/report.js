"use strict";
// The slider: every number and word comes from the page's data, which was computed with the design.
(function slideThroughDepths() {
  const data = document.getElementById("stops");
  if (!data) return;
  const { left, across, stops } = JSON.parse(data.textContent);
  const slider = document.getElementById("depth-slider");
  const curves = document.getElementById("errors");
  const rows = document.querySelectorAll("#lenses tbody tr");

  function show(index) {
    const stop = stops[index];
    for (const name of ["depth", "best", "error", "counted", "baseline", "blur"]) {
      const place = document.getElementById("told-" + name);
      if (place) place.textContent = stop[name];
    }
    slider.setAttribute("aria-valuetext", `${stop.depth}: ${stop.best}, error ${stop.error}`);
    for (const part of document.querySelectorAll(".lit")) part.classList.remove("lit");
    for (const id of stop.lit) document.getElementById(id)?.classList.add("lit");
    rows.forEach((row, lens) => row.classList.toggle("lit", stop.lenses.includes(lens + 1)));
    document.getElementById("errors-depth-line").setAttribute("transform", `translate(${stop.right} 0)`);
    document.getElementById("errors-depth-dot").setAttribute("transform", `translate(${stop.right} ${stop.down})`);
  }

  curves.addEventListener("click", (event) => {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(curves.getScreenCTM().inverse());
    const right = Math.min(Math.max(point.x - left, 0), across);
    const nearest = stops.reduce((best, stop, i) => (Math.abs(stop.right - right) < Math.abs(stops[best].right - right) ? i : best), 0);
    slider.value = nearest;
    show(nearest);
  });
  slider.addEventListener("input", () => show(Number(slider.value)));
  document.documentElement.classList.add("lively");
  curves.classList.add("curves");
  document.getElementById("depth").hidden = false;
  // A browser that comes back to the page may remember where the slider was.
  show(Number(slider.value));
})();

// A sweep: a point, a layout and a row choose the same job; lists choose the chart; heads sort the table.
(function linkJobs() {
  const panel = document.getElementById("chosen");
  const choices = ["question", "up", "right"].map((name) => [name, document.getElementById("choose-" + name)]);
  const charts = document.querySelectorAll(".charts figure");
  const table = document.querySelector("table.sorted");
  if (!panel && !table) return;
  document.documentElement.classList.add("lively");

  function choose(job) {
    const card = document.getElementById("job-" + job);
    for (const other of document.querySelectorAll(".chosen")) other.classList.remove("chosen");
    for (const link of document.querySelectorAll(`a[href="#job-${job}"]`)) link.classList.add("chosen");
    for (const place of [card, table?.querySelector(`tr[data-job="${job}"]`)]) place?.classList.add("chosen");
    if (!panel) return;
    document.getElementById("chosen-title").textContent = "Job " + job;
    const copy = card ? card.cloneNode(true) : document.createElement("p");
    if (!card) copy.textContent = "Its layout has no room here.";
    // The original keeps its ids, and the copy's pictures use what they name there.
    for (const part of [copy, ...copy.querySelectorAll("[id]")]) part.removeAttribute("id");
    for (const part of copy.querySelectorAll("[aria-labelledby]")) part.removeAttribute("aria-labelledby");
    copy.querySelector("h3")?.remove();
    const details = copy.querySelector("details");
    details?.querySelector("summary").remove();
    details?.replaceWith(...details.childNodes);
    document.getElementById("chosen-job").replaceChildren(...(card ? copy.childNodes : [copy]));
    panel.hidden = false;
  }

  function showChart() {
    let shown = 0;
    for (const chart of charts) {
      chart.hidden = !choices.every(([name, list]) => !list || chart.dataset[name] === list.value);
      shown += chart.hidden ? 0 : 1;
    }
    const none = document.getElementById("no-chart");
    if (none) none.textContent = shown ? "" : "The jobs do not differ in both.";
  }

  function sortBy(head) {
    const heads = [...head.parentElement.children];
    const up = head.getAttribute("aria-sort") !== "ascending";
    for (const other of heads) other.setAttribute("aria-sort", other === head ? (up ? "ascending" : "descending") : "none");
    const words = (row) => row.children[heads.indexOf(head)].textContent;
    const compare = (a, b) => {
      const [x, y] = [Number(a), Number(b)];
      if (Number.isNaN(x) !== Number.isNaN(y)) return Number.isNaN(x) ? 1 : -1;
      return (Number.isNaN(x) ? a.localeCompare(b) : x - y) * (up ? 1 : -1);
    };
    table.tBodies[0].append(...[...table.tBodies[0].rows].sort((one, other) => compare(words(one), words(other))));
  }

  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#job-"]');
    const job = link ? link.getAttribute("href").slice(5) : event.target.closest(".card[id], tr[data-job]")?.dataset.job;
    if (job === undefined || event.target.closest("details")) return;
    if (link) event.preventDefault();
    choose(job);
    const seen = panel?.getBoundingClientRect();
    if (seen && (seen.bottom < 80 || seen.top > innerHeight - 80)) panel.scrollIntoView();
  });
  for (const row of table ? table.tBodies[0].rows : []) row.dataset.job = row.cells[0].textContent;
  for (const card of document.querySelectorAll(".card[id]")) card.dataset.job = card.id.slice(4);
  for (const head of table ? table.tHead.rows[0].cells : []) {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    head.setAttribute("aria-sort", "none");
    button.addEventListener("click", () => sortBy(head));
  }
  for (const [, list] of choices) list?.addEventListener("change", showChart);
  showChart();
  const asked = location.hash.startsWith("#job-") ? location.hash.slice(5) : panel?.dataset.first;
  if (asked) choose(asked);
})();
