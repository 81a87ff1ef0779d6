// The page: joins the parts.

import { Commissioning } from "./commissioning.js";
import { by } from "./dom.js";
import { showEdition } from "./edition.js";
import { Events } from "./events.js";
import { Faults } from "./faults.js";
import { Known } from "./known.js";
import { Link } from "./link.js";
import { Live } from "./live.js";
import { Parameters } from "./parameters.js";
import { Run } from "./run.js";
import { Scope } from "./scope.js";
import { tabs } from "./tabs.js";

history.replaceState(null, "", location.pathname); // the token does not stay in the address line

const link = new Link();
const events = new Events();
const fail = (error) => events.note(error.message);
link.on(["hello", "again"], ({ version, where }) => (by("where").textContent = `${version} · ${where}`));

tabs();
link.on(["hello", "again"], showEdition);
const run = new Run(link, events);
const parameters = new Parameters(link, fail);
new Live(link, fail);
new Scope(link, fail);
new Faults(link, fail);
new Commissioning(link, run, parameters, fail);
events.follow(link);
new Known(link, events);
link.connect();
