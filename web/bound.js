// Text for the error bound of a picture, from a response header or a certificate in JSON.

import { roundedUp } from "./progress.js";

// Parses "rms=0.0044;kind=estimated;met=?1;reason=\"a; b\"" into {name: text}. ?1 and ?0 become booleans.
export function parametersOf(header) {
  const fields = {};
  for (const [, name, quoted, plain] of (header ?? "").matchAll(/([\w-]+)=(?:"([^"]*)"|([^;]*))/g)) {
    const text = quoted ?? plain;
    fields[name] = text === "?1" || text === "?0" ? text === "?1" : text;
  }
  return fields;
}

// Returns the fields of an Orrery-Error-Bound header from a certificate in JSON.
export function fieldsOf({ total, known, terms, space }) {
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

const strength = (kind) => (kind === "estimated" ? "95 % confidence" : kind);
const upperBoundText = (rms, kind, space) => `≤ ${roundedUp(Number(rms))} (${strength(kind)})${unit(space)}`;

// Returns the suffix for the unit of an error: "" for linear radiance, else display values from 0 to 1.
export const unit = (space) => (space === "display" ? " in display values" : "");

// Returns a text such as "error ≤ 0.0044 (95 % confidence)". If the total error is unknown, the text names
// the unknown terms and the bound of the known terms.
export function boundText(fields) {
  const { rms, kind, because, known, space } = fields;
  if (!kind) return "error unknown: not reported by the service";
  if (kind !== "unknown") return `error ${upperBoundText(rms, kind, space)}`;
  const unknown = `error unknown because of ${because}`;
  if (known === "unknown") return unknown;
  return `${unknown}; other errors ${upperBoundText(known, fields["known-kind"], space)}`;
}

// Returns {missed, text} for a picture rendered to a budget. `budget` and `bound`: fields of their headers.
export function budgetText(budget, bound) {
  const took = budget.used ? `${roundedUp(Number(budget.used))} s of ${budget.seconds} s` : "";
  const aim = budget.error ? `error limit: ${budget.error}` : "";
  const text = [took, aim, boundText(bound)].filter(Boolean).join("; ");
  if (budget.met) return { missed: false, text: `Limit met: ${text}` };
  return { missed: true, text: `Limit missed: ${budget.reason || "no reason given"}; ${text}` };
}
