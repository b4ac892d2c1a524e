// Mistakes of what the service does with requests it has understood, as faults.mjs has them: fault 20 shares work
// unfairly or does it twice, 21 loses what jobs did, 22 lets in who may not.

const entry = (fault, about, file, from, to, target, ...tests) => ({
  fault, about, file, from, to, target, tests,
});
const admission = (...rest) => entry(20, rest[0], "server/app/admission.cpp", rest[1], rest[2], "test_app", ...rest.slice(3));
const pictures = (...rest) => entry(20, rest[0], "server/app/pictures.cpp", rest[1], rest[2], "test_app", ...rest.slice(3));

export const serviceFaults = [
  admission("work starts in the order in which it came", "rank(*it) < rank(*best)", "false",
            "Admission.ClientsShareByCost*", "Admission.InteractiveWorkGoesFirst*"),
  admission("batch work starves", "const bool batch_starves = running_batch_ == 0 && latest_ != Lane::batch;", "const bool batch_starves = false;",
            "Admission.InteractiveWorkGoesFirst*"),
  admission("batch work takes every place", "running_batch_ < std::max(1, limits_.running / 2)", "true",
            "Admission.InteractiveWorkGoesFirst*"),
  admission("what waits is not bounded", "waiting + cost <= limits_.queue_rays", "true", "Admission.WhatWaitsIsBounded*"),
  admission("who comes last is turned away, however little it asks", "own >= waiting_cost(lane, &greediest->demand.client)",
            "true", "Admission.WhoHasMostWaiting*"),
  admission("the rate is a guess", "busy_s_ > 0 ? done_cost_ / busy_s_ : kExpectedRate", "kExpectedRate",
            "Admission.RetryAfter*"),
  pictures("each makes its own", "if (first) {\n      lock.unlock();", "if (true) {\n      lock.unlock();",
           "Pictures.ThatManyAskForAtOnce*"),
  pictures("the first takes the picture along when it leaves", "std::all_of(work.waiting", "std::any_of(work.waiting",
           "Pictures.AreFinishedForTheOthers*"),
  pictures("the others are refused with the first", "} catch (const Busy&) {\n    error = std::current_exception();",
           "} catch (const Busy&) {\n    error = std::current_exception();\n    theirs = true;", "Pictures.RefusedToOne*"),
  entry(20, "pictures of all formats are one", "server/app/app.cpp", "key + std::to_string(static_cast<int>(format))", "key",
        "test_http", "Render.AcceptChoosesTheFormat"),
  entry(21, "events begin anew for who comes back", "server/routes/jobs.cpp",
        "events = Events{job, seen}", "events = Events{job, 0}", "test_http",
        "JobTest.WhoComesBack*"),
  entry(21, "a key starts a job each time", "server/app/jobs.cpp", "return !key.empty() && e.key == key", "return false && e.key == key",
        "test_http", "JobTest.TheSameKey*"),
  entry(21, "a deleted job goes on", "server/app/job.cpp", "void Job::cancel() { cancelled_ = true; }", "void Job::cancel() {}",
        "test_http", "JobTest.DeletedIsCancelled*"),
  entry(22, "every token may do everything", "server/routes/access.cpp", "if (!holder.may[index])", "if (false)", "test_http",
        "Access.NeedsAToken*"),
  entry(22, "links do not end", "server/routes/access.cpp", "if (std::chrono::duration_cast<std::chrono::seconds>(now).count() > *expires)", "if (false)", "test_http",
        "Access.SignedLinks*"),
  entry(22, "a link holds for other parameters", "server/routes/access.cpp", "text += '\\n' + name + '=' + value;", "", "test_http",
        "Access.SignedLinks*"),
  entry(22, "a link's end is not signed", "server/app/access.cpp", 'return std::to_string(expires) + " " + std::string(address);',
        "return std::string(address);", "test_http", "Access.SignedLinks*"),
  entry(22, "origins are listed by their beginning", "server/http/cors.cpp", "listed == *origin", "origin->starts_with(listed)",
        "test_http", "Cors.OnlyListed*"),
  entry(22, "any domain is our own origin", "server/http/cors.cpp", "(domains || names_no_domain(host))", "true", "test_http",
        "Cors.Domains*"),
  entry(22, "a name that begins like localhost is", "server/http/authority.cpp", 'equal_ignoring_case(host, "localhost")',
        'host.starts_with("localhost")', "test_http", "Cors.Domains*"),
  entry(22, "one client has all streams", "server/app/streams.cpp", "own == by_client_.end() ? 0 : own->second", "0",
        "test_http", "Streams.*"),
];
