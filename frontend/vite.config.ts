import { defineConfig } from "vitest/config";

// The page is served from a folder of the Python package, below whatever path a proxy gives it: hence the relative base.
export default defineConfig({
  base: "./",
  build: {
    outDir: "../src/linkwright/viewer/page",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 900,
  },
  test: {
    include: ["test/**/*.test.ts"],
    // Its colours are tested; other styles are nothing to tests.
    css: { include: [/theme\.css/] },
  },
});
