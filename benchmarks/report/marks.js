// How a curve is told from the others: colour, marker and dashes together, so that no reader depends on colour.
import {symbol, symbolCircle, symbolCross, symbolDiamond, symbolSquare, symbolStar, symbolTriangle,
        symbolWye} from "d3-shape";
import {create} from "d3-selection";

const SYMBOLS = [symbolCircle, symbolSquare, symbolTriangle, symbolDiamond, symbolCross, symbolStar, symbolWye];
const DASHES = [null, "6 3", "2 3", "9 3 2 3", "12 4"];
const COLOURS = 6;  // as in page.css

export function colour(curve) {
  return `var(--curve-${curve.index % COLOURS})`;
}

export function dashes(curve) {
  return DASHES[curve.index % DASHES.length];
}

/** The marker's outline around (0, 0), `area` in square pixels. */
export function marker(curve, area = 70) {
  return symbol().type(SYMBOLS[curve.index % SYMBOLS.length]).size(area)();
}

/** A piece of the curve with its marker, for legends. */
export function swatch(curve) {
  const svg = create("svg").attr("class", "swatch").attr("width", 34).attr("height", 14).attr("viewBox", "-17 -7 34 14")
    .attr("aria-hidden", "true");
  svg.append("path").attr("d", "M-16,0H16").attr("fill", "none").attr("stroke", colour(curve)).attr("stroke-width", 2)
    .attr("stroke-dasharray", dashes(curve));
  svg.append("path").attr("d", marker(curve)).attr("fill", colour(curve));
  return svg.node();
}
