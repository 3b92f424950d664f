// What draws diagrams, with its style sheet: fetched with the first diagram, see `plot-chart.ts`.
import "uplot/dist/uPlot.min.css";

export { default as UPlot } from "uplot";
