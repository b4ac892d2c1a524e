// What a picture tells of its error, in words. The service says it as parameters of a header, or as JSON.

import { rounded_up } from "./progress.js";

// "rms=0.0044;kind=estimated;met=?1;reason=\"a; b\"" as {name: text}; truth values as booleans.
export function parameters_of(header) {
  const fields = {};
  for (const [, name, quoted, plain] of (header ?? "").matchAll(/([\w-]+)=(?:"([^"]*)"|([^;]*))/g)) {
    const text = quoted ?? plain;
    fields[name] = text === "?1" || text === "?0" ? text === "?1" : text;
  }
  return fields;
}

// The same fields of a certificate as JSON.
export function fields_of({ total, known, terms, space }) {
  const number = (value) => (value === null ? "unknown" : String(value));
  const because = terms.filter(({ bound }) => bound.kind === "unknown").map(({ subject }) => subject);
  return {
    rms: number(total.rms),
    kind: total.kind,
    because: because.join(", "),
    known: number(known.rms),
    "known-kind": known.kind,
    space,
  };
}

const strength = (kind) => (kind === "estimated" ? "95 %, estimated" : kind);
const at_most = (rms, kind, space) => `≤ ${rounded_up(Number(rms))} (${strength(kind)})${unit(space)}`;

// Errors are in linear radiance unless they are of what a screen shows, from 0 to 1.
export const unit = (space) => (space === "display" ? ", on a display" : "");

// "error ≤ 0.0044 (95 %, estimated)"; of what is unknown, that it is, why, and what the rest is at most.
export function bound_words(fields) {
  const { rms, kind, because, known, space } = fields;
  if (!kind) return "error unknown: the service does not tell it";
  if (kind !== "unknown") return `error ${at_most(rms, kind, space)}`;
  const rest = known === "unknown" ? "nothing of it is known" : `the rest ${at_most(known, fields["known-kind"], space)}`;
  return `error unknown, because of ${because}; ${rest}`;
}

// What became of a budget: {missed, text}.
export function budget_words(budget, bound) {
  const took = budget.used ? `${rounded_up(Number(budget.used))} s of ${budget.seconds} s` : "";
  const aim = budget.error ? `error limit: ${budget.error}` : "";
  const words = [took, aim, bound_words(bound)].filter(Boolean).join("; ");
  if (budget.met) return { missed: false, text: `Limit kept: ${words}` };
  return { missed: true, text: `Limit missed: ${budget.reason || "the service does not say why"}; ${words}` };
}
