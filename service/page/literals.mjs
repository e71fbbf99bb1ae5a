// Finds words in components that no catalogue has: `node literals.mjs [FOLDER]` names each and fails.
import { readFile, readdir } from "node:fs/promises";
import { dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import ts from "typescript";

const SOURCES = join(dirname(fileURLToPath(import.meta.url)), "src");

/** What screens and screen readers show of an attribute, of elements and of our own components. */
const SHOWN = new Set([
  "alt", "aria-description", "aria-label", "aria-roledescription", "aria-valuetext", "caption",
  "heading", "help", "label", "legend", "placeholder", "text", "title", "words",
]);
/** The name of the program. */
const NAMES = new Set(["Maquette"]);
const LETTER = /\p{L}/u;

const folder = resolve(process.argv[2] ?? SOURCES);
const found = [];
for (const file of await readdir(folder, { recursive: true })) {
  if (!file.endsWith(".tsx")) continue;
  const source = ts.createSourceFile(file, await readFile(join(folder, file), "utf8"), ts.ScriptTarget.Latest, true, ts.ScriptKind.TSX);
  look(source, source);
}
for (const { place, text } of found) console.error(`${place}: ${JSON.stringify(text)} belongs in src/messages`);
process.exitCode = found.length > 0 ? 1 : 0;

function look(node, source) {
  // What is typed into a terminal is no message.
  if (ts.isJsxElement(node) && node.openingElement.tagName.getText() === "code") return;
  if (ts.isJsxText(node)) note(node, node.text, source);
  if (ts.isJsxExpression(node) && node.expression && !ts.isJsxAttribute(node.parent)) shown(node.expression, source);
  if (ts.isJsxAttribute(node) && SHOWN.has(node.name.getText()) && node.initializer) {
    shown(ts.isJsxExpression(node.initializer) ? node.initializer.expression : node.initializer, source);
  }
  // Options of a choice and the like: objects with a label.
  if (ts.isPropertyAssignment(node) && SHOWN.has(node.name.getText())) shown(node.initializer, source);
  ts.forEachChild(node, (child) => look(child, source));
}

/** The literals that an expression may come to: not those it is compared with or calls with. */
function shown(expression, source) {
  if (!expression) return;
  if (ts.isStringLiteral(expression) || ts.isNoSubstitutionTemplateLiteral(expression)) note(expression, expression.text, source);
  else if (ts.isTemplateExpression(expression)) {
    note(expression, [expression.head, ...expression.templateSpans.map((span) => span.literal)].map((part) => part.text).join("…"), source);
  } else if (ts.isParenthesizedExpression(expression) || ts.isAsExpression(expression) || ts.isNonNullExpression(expression)) {
    shown(expression.expression, source);
  } else if (ts.isConditionalExpression(expression)) {
    shown(expression.whenTrue, source);
    shown(expression.whenFalse, source);
  } else if (ts.isBinaryExpression(expression)) {
    const { kind } = expression.operatorToken;
    if (kind === ts.SyntaxKind.PlusToken || kind === ts.SyntaxKind.QuestionQuestionToken || kind === ts.SyntaxKind.BarBarToken) {
      shown(expression.left, source);
    }
    if (kind !== ts.SyntaxKind.EqualsEqualsEqualsToken && kind !== ts.SyntaxKind.ExclamationEqualsEqualsToken) {
      shown(expression.right, source);
    }
  }
}

function note(node, text, source) {
  const words = text.replace(/\s+/g, " ").trim();
  if (!LETTER.test(words) || NAMES.has(words)) return;
  const { line } = source.getLineAndCharacterOfPosition(node.getStart());
  found.push({ place: `${relative(".", join(folder, source.fileName))}:${line + 1}`, text: words });
}
