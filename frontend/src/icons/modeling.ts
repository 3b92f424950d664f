/** Icons of modeling the world. */
export const MODELING_PATHS = {
  build: "M7.5 2.2l5 2.6v2M2.5 4.8l5-2.6M2.5 4.8v6l5 2.8M2.5 4.8l5 2.7 2.6-1.4M7.5 7.5v6M9.2 13.8l.4-1.9 3.6-3.6 1.5 1.5-3.6 3.6z",
  shapeBox: "M8 1.8l5.5 3v6.4L8 14.2l-5.5-3V4.8zM2.5 4.8L8 8l5.5-3.2M8 8v6.2",
  shapeCylinder: "M3.5 4a4.5 2 0 109 0 4.5 2 0 10-9 0v8c0 1.1 2 2 4.5 2s4.5-.9 4.5-2V4",
  shapeSphere: "M8 2a6 6 0 100 12A6 6 0 008 2zM2 8c0 1.3 2.7 2.3 6 2.3s6-1 6-2.3",
  shapeWall: "M1.8 4h12.4v8.5H1.8zM1.8 8.2h12.4M6 4v4.2M11 4v4.2M3.8 8.2v4.3M8.5 8.2v4.3",
  shapeRamp: "M1.8 12.5h12.4V4.5z",
  bulb: "M6 12.2h4M6.5 14.2h3M5.8 9.8a4.2 4.2 0 114.4 0c-.4.4-.4.9-.4 1.4H6.2c0-.5 0-1-.4-1.4z",
  sun: "M8 5a3 3 0 100 6 3 3 0 000-6M8 1.5V3M8 13v1.5M1.5 8H3M13 8h1.5M3.4 3.4l1 1M11.6 11.6l1 1M3.4 12.6l1-1M11.6 4.4l1-1",
  spot: "M6 2h4l1 4H5zM4.5 8l-2 5.5M8 8v6M11.5 8l2 5.5",
  library: "M2.5 2.5h3v11h-3zM5.5 2.5h3v11h-3zM9.3 3.3l2.8-.8 2.4 10.2-2.8.8z",
  turn: "M13 8a5 5 0 11-1.6-3.7M13.2 2v3h-3",
  scale: "M2.5 8.5h5v5h-5zM9.5 6.5l4-4M10 2.5h3.5V6M2.5 5.5v-3h3",
  magnet: "M3 2.5h3v6a2 2 0 004 0v-6h3v6a5 5 0 01-10 0zM3 5.2h3M10 5.2h3",
  group: "M2 2h12v12H2zM4.5 4.5h4v4h-4zM8.5 8.5h3v3h-3z",
  ungroup: "M2 2h6v6H2zM9.5 9.5H14V14H9.5zM10.5 2.5h3v3M5.5 13.5h-3v-3",
} as const;
