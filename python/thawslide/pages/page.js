// Interactive plots of a page. The page contains all data; nothing is loaded.
(async () => {
  const element = (name) => document.getElementById(name);
  const fail = (text) => {
    const note = document.createElement("p");
    note.className = "note";
    note.textContent = text;
    (element("view") || element("events")).replaceWith(note);
  };
  if (typeof DecompressionStream === "undefined") {
    fail("Interactive plots need a newer browser: Chrome 80, Edge 80, Firefox 113, Safari 16.4 or later.");
    return;
  }

  const inflated = (name) => {
    const text = atob(element(name).textContent);
    const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
  };
  const script = document.createElement("script");
  script.textContent = await inflated("plotly").text();
  document.head.append(script);
  // The buttons would cover the legend on a narrow screen.
  const displayModeBar = matchMedia("(max-width: 700px)").matches ? false : "hover";
  const modeBarButtonsToRemove = ["select2d", "lasso2d"];
  const options = { responsive: true, displaylogo: false, displayModeBar, modeBarButtonsToRemove };
  const font = { family: "system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif", size: 13 };

  // Paper is narrower than most windows: plots have its width while the page is printed.
  const resize = (size) => document.querySelectorAll(".js-plotly-plot").forEach((plot) => Plotly.relayout(plot, size));
  window.addEventListener("beforeprint", () => resize({ autosize: false, width: 680 }));
  window.addEventListener("afterprint", () => resize({ autosize: true, width: null }));

  if (element("events-parts")) {
    const events = JSON.parse(element("events-parts").textContent);
    // Names do not fit between the points of a narrow plot; a touch shows them.
    if (window.matchMedia("(max-width: 700px)").matches) {
      events.traces.forEach((trace) => (trace.mode = "markers"));
    }
    await Plotly.newPlot("events", events.traces, { ...events.layout, font }, options);
  }
  if (!element("view-parts")) {
    return;
  }

  const view = JSON.parse(element("view-parts").textContent);
  const steps = new Uint16Array(await inflated("view-data").arrayBuffer());
  const unpacked = ([start, count, low, high]) =>
    Array.from(steps.subarray(start, start + count), (step) =>
      step === 65535 ? null : low + ((high - low) * step) / 65534,
    );
  const perKm = (values) => values.map((value) => (value === null ? null : value / 1000));
  const fieldOf = () => view.fields[Number(element("view-field").value)];
  const momentOf = () => Number(element("view-time").value);
  const valuesOf = (field) => unpacked(field.values[field.isStatic ? 0 : momentOf()]);
  const unitOf = (field) => (field.unit === "–" ? "" : " " + field.unit);
  const titleOf = (field) => field.words + " (" + field.unit + ")";
  const barOf = (field) => ({ title: { text: titleOf(field), side: "right" }, thickness: 16, outlinewidth: 0 });

  // A map: hillshade, field, lines and probes.
  const map = {
    traces() {
      const grid = view.grid;
      const rows = (values) =>
        Array.from({ length: values.length / grid.columns }, (_, row) =>
          values.slice(row * grid.columns, (row + 1) * grid.columns),
        );
      map.rows = rows;
      const field = {
        type: "heatmap", z: rows(valuesOf(fieldOf())), customdata: rows(unpacked(view.elevation)), opacity: 0.85,
        x0: grid.x / 1000, dx: grid.dx / 1000, y0: grid.y / 1000, dy: grid.dy / 1000, hoverongaps: false,
      };
      const lines = view.lines.map((line) => ({
        type: "scatter", mode: "lines", name: line.words, x: perKm(unpacked(line.x)), y: perKm(unpacked(line.y)),
        hoverinfo: "skip",
        line: { dash: line.dash, width: 1.6, color: line.words === "flow path" ? "#0072B2" : "#222222" },
      }));
      const places = Object.entries(view.probes);
      const probes = {
        type: "scatter", mode: "markers+text", name: "probe", text: places.map(([name]) => name),
        x: perKm(places.map(([, place]) => place[0])), y: perKm(places.map(([, place]) => place[1])),
        textposition: "top center", textfont: { shadow: "0 0 3px white, 0 0 3px white" }, hovertemplate: "probe %{text}<extra></extra>",
        marker: { symbol: "diamond", size: 9, color: "#CC79A7", line: { color: "white", width: 1 } },
      };
      return [field, ...lines, ...(places.length ? [probes] : [])];
    },
    layout() {
      const [west, east, south, north] = view.box.map((value) => value / 1000);
      const [left, right, bottom, top] = view.shadeBox.map((value) => value / 1000);
      const image = {
        source: view.shade, xref: "x", yref: "y", x: left, y: top, sizex: right - left, sizey: top - bottom,
        sizing: "stretch", layer: "below",
      };
      const axis = { tickformat: ",~f", showgrid: false, zeroline: false, constrain: "domain" };
      return {
        images: [image],
        xaxis: { ...axis, range: [west, east], title: { text: "easting (km)" } },
        yaxis: { ...axis, range: [south, north], scaleanchor: "x", automargin: true,
          title: { text: "northing (km)", standoff: 10 } },
        legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom" },
      };
    },
    update() {
      const field = fieldOf();
      const hover =
        field.words + ": %{z:,.3~r}" + unitOf(field) +
        "<br>easting %{x:,.3f} km<br>northing %{y:,.3f} km<br>elevation %{customdata:,.0f} m<extra></extra>";
      return Plotly.restyle("view", {
        z: [map.rows(valuesOf(field))], zmin: field.low, zmax: field.high, colorscale: [field.colours],
        colorbar: [barOf(field)], hovertemplate: hover,
      }, [0]);
    },
    follow() {},
  };

  // A section: terrain, all particles in grey under fields of the base, and the coloured points.
  const section = {
    traces() {
      const [x, y] = view.terrain.map(unpacked);
      const bottom = Math.min(...y) - 0.05 * (Math.max(...y) - Math.min(...y));
      return [
        { type: "scatter", mode: "lines", name: "bottom", x: [x[0], x.at(-1)], y: [bottom, bottom], hoverinfo: "skip",
          line: { width: 0 }, showlegend: false },
        { type: "scatter", mode: "lines", name: "terrain", x, y, fill: "tonexty", fillcolor: "#D9D4CB",
          line: { color: "#6B6459", width: 1.5 },
          hovertemplate: "terrain" + section.hover() },
        { type: "scatter", mode: "markers", name: "particles", x: [], y: [], hoverinfo: "skip",
          marker: { size: 4, color: "#9A9A9A" } },
        { type: "scatter", mode: "markers", name: "field", x: [], y: [], marker: { size: 5 } },
      ].slice(x.length ? 0 : 2);
    },
    layout() {
      const axis = { tickformat: ",~f", gridcolor: "#E4E4E4", zeroline: false };
      return {
        showlegend: false,
        xaxis: { ...axis, title: { text: view.axes[0] + " (m)" } },
        yaxis: { ...axis, automargin: true, title: { text: view.axes[1] + " (m)", standoff: 10 } },
      };
    },
    hover() {
      return `<br>${view.axes[0]} %{x:,.0f} m<br>${view.axes[1]} %{y:,.0f} m<extra></extra>`;
    },
    places(name) {
      const points = view.points[name];
      return [unpacked(points.x[momentOf()]), unpacked(points.y[momentOf()])];
    },
    update() {
      const field = fieldOf();
      const last = element("view").data.length - 1;
      const [x, y] = section.places(field.points);
      const [greyX, greyY] = field.points === "particles" ? [[], []] : section.places("particles");
      const hover =
        field.words + ": %{marker.color:,.3~r}" + unitOf(field) +
        section.hover();
      const marker = {
        size: 5, color: valuesOf(field), colorscale: field.colours, cmin: field.low, cmax: field.high,
        showscale: true, colorbar: barOf(field),
      };
      return Plotly.restyle("view", {
        x: [greyX, x], y: [greyY, y], hovertemplate: ["", hover],
        marker: [{ size: 4, color: "#9A9A9A" }, marker],
      }, [last - 1, last]);
    },
    follow() {
      const ranges = section.places("particles").map((values) => {
        const known = values.filter((value) => value !== null);
        const [low, high] = [Math.min(...known), Math.max(...known)];
        const margin = 0.05 * (high - low) + 5;
        return [low - margin, high + margin];
      });
      return Plotly.relayout("view", { "xaxis.range": ranges[0], "yaxis.range": ranges[1] });
    },
    exaggeration() {
      const { xaxis, yaxis } = element("view")._fullLayout;
      const scale = (axis) => axis._length / Math.abs(axis.range[1] - axis.range[0]);
      element("view-exaggeration").textContent = Number((scale(yaxis) / scale(xaxis)).toPrecision(2));
    },
  };

  const kind = view.kind === "map" ? map : section;
  view.fields.forEach((field, place) => element("view-field").add(new Option(field.words, place)));
  element("view-time").max = view.times.length - 1;
  let timer = null;
  const pause = () => {
    clearInterval(timer);
    timer = null;
    element("view-play").textContent = "Play";
  };
  const update = async () => {
    const field = fieldOf();
    if (field.isStatic) {
      pause();
    }
    element("view-time").disabled = element("view-play").disabled = Boolean(field.isStatic);
    element("view-time-text").textContent = field.isStatic ? "whole run" : view.times[momentOf()] + " s";
    await kind.update();
    if (element("view-follow").checked) {
      await kind.follow();
    }
  };
  const common = { font, margin: { l: 75, r: 10, t: 40, b: 64 }, hovermode: "closest", plot_bgcolor: "#FFFFFF" };
  await Plotly.newPlot("view", kind.traces(), { ...common, ...kind.layout() }, options);
  if (kind === section) {
    element("view-follow-label").hidden = false;
    element("view-exaggeration-text").hidden = false;
    element("view").on("plotly_afterplot", section.exaggeration);
  }
  element("view-field").addEventListener("change", update);
  element("view-time").addEventListener("input", update);
  element("view-follow").addEventListener("change", async () => {
    await (element("view-follow").checked
      ? update()
      : Plotly.relayout("view", { "xaxis.autorange": true, "yaxis.autorange": true }));
  });
  element("view-play").addEventListener("click", () => {
    if (timer !== null) {
      pause();
      return;
    }
    const slider = element("view-time");
    if (slider.value === slider.max) {
      slider.value = 0;
    }
    element("view-play").textContent = "Pause";
    timer = setInterval(() => {
      slider.value = momentOf() + 1;
      update();
      if (slider.value === slider.max) {
        pause();
      }
    }, 400);
  });
  element("view-time").value = Math.round(0.5 * (view.times.length - 1));
  await update();
  document.body.dataset.plots = "ready";
})();
