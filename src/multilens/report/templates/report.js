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
