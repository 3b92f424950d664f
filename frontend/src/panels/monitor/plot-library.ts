// The plotting library with its style sheet, fetched with the first plot; see `plot-chart.ts`.
import "uplot/dist/uPlot.min.css";

export { default as UPlot } from "uplot";
