import { defineConfig } from "vite";

// The page of exports: one script and one style sheet, which `viewer/features/export/html.py` puts into a file with the robot.
export default defineConfig({
  base: "./",
  publicDir: false,
  build: {
    outDir: "../src/linkwright/page/built/export",
    emptyOutDir: true,
    target: "es2022",
    cssCodeSplit: false,
    assetsInlineLimit: 100_000_000,
    chunkSizeWarningLimit: 2000,
    lib: { entry: "src/export/main.ts", name: "linkwrightExport", formats: ["iife"], fileName: () => "export.js", cssFileName: "export" },
  },
});
