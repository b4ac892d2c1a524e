import js from "@eslint/js";
import globals from "globals";

// Files that follow the naming rules: camelCase, UPPER_CASE for constants, no prefix.
const named = ["web/**/*.js", "tests/browser/**/*.mjs", "tests/lint/web.test.mjs", "eslint.config.js"];
// Scripts for Node that also contain functions for the browser.
const forBrowser = ["tests/browser/**/*.mjs", "tests/bench/drag.mjs", "scenes/generate-thumbnails.mjs"];

export default [
  { ignores: ["build*/", "node_modules/"] },
  js.configs.recommended,
  {
    languageOptions: { ecmaVersion: 2024, sourceType: "module" },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      eqeqeq: "error",
      "no-unused-vars": ["error", { ignoreRestSiblings: true }],
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": "error",
    },
  },
  { files: ["web/**/*.js"], languageOptions: { globals: globals.browser } },
  { files: ["**/*.mjs"], languageOptions: { globals: globals.node } },
  { files: forBrowser, languageOptions: { globals: { ...globals.node, ...globals.browser } } },
  {
    files: named,
    rules: {
      camelcase: ["error", { properties: "never" }], // the API has keys with underscores
      "no-restricted-syntax": [
        "error",
        { selector: "Identifier[name=/^k[A-Z]/]", message: "Constants have no prefix: use UPPER_CASE." },
      ],
    },
  },
];
