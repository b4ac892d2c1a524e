// Text for the error bound of a picture, from the parameters of a header or from JSON.

import { rounded_up } from "./progress.js";

// Parses "rms=0.0044;kind=estimated;met=?1;reason=\"a; b\"" into {name: text}. ?1 and ?0 become booleans.
export function parameters_of(header) {
  const fields = {};
  for (const [, name, quoted, plain] of (header ?? "").matchAll(/([\w-]+)=(?:"([^"]*)"|([^;]*))/g)) {
    const text = quoted ?? plain;
    fields[name] = text === "?1" || text === "?0" ? text === "?1" : text;
  }
  return fields;
}

// Returns the same fields from a certificate in JSON.
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

// Suffix for the unit of an error: empty for linear radiance, else display values from 0 to 1.
export const unit = (space) => (space === "display" ? ", on a display" : "");

// Returns a text such as "error ≤ 0.0044 (95 %, estimated)". For an unknown error, names the cause and the
// bound of the remaining terms.
export function bound_words(fields) {
  const { rms, kind, because, known, space } = fields;
  if (!kind) return "error unknown: the service does not tell it";
  if (kind !== "unknown") return `error ${at_most(rms, kind, space)}`;
  const rest = known === "unknown" ? "nothing of it is known" : `the rest ${at_most(known, fields["known-kind"], space)}`;
  return `error unknown, because of ${because}; ${rest}`;
}

// Returns {missed, text} for the outcome of a budget.
export function budget_words(budget, bound) {
  const took = budget.used ? `${rounded_up(Number(budget.used))} s of ${budget.seconds} s` : "";
  const aim = budget.error ? `error limit: ${budget.error}` : "";
  const words = [took, aim, bound_words(bound)].filter(Boolean).join("; ");
  if (budget.met) return { missed: false, text: `Limit kept: ${words}` };
  return { missed: true, text: `Limit missed: ${budget.reason || "the service does not say why"}; ${words}` };
}
