#include "daemon/commands/line/command_pages.hpp"

#include <algorithm>

namespace recald::daemon {
namespace {

using PageList = std::vector<CommandPage>;

constexpr CommandFile kPageSite{"site.toml", "The site file, read"};
constexpr CommandFile kPageData{"*.csv, *.xlsx, *.xml, *.epw",
                                "Readings and weather that the site file names, read"};
constexpr CommandFile kPageStore{"site.db",
                                 "The store beside the site file, read where meters are live"};
constexpr CommandFile kPageModels{"site.models/", "Versions of the model beside the site file"};
constexpr CommandFile kPageFleet{"fleet.toml", "The file of the fleet, read"};

PageList setup_pages() {
  return {
      {"",
       "recald reads the meters of a building, turns readings into months, calibrates a model of "
       "the building to them, says what the model is missing, and keeps all of that up to date "
       "on a gateway. A site is described by one TOML file. Without a command it prints what it "
       "can do.",
       {{"recald report export.csv --timezone Europe/Berlin",
         "A first page from an export of meters"},
        {"recald init export.csv --timezone Europe/Berlin", "A site file from the same export"},
        {"recald run site.toml", "The daemon on a gateway"}},
       {{"site.toml", "The site file; recald schema describes it for editors"},
        {"site.db", "The store of live meters, beside the site file unless it says otherwise"}}},
      {"init",
       "Looks at exports of meters (CSV, other delimited text, .xlsx, Green Button XML), finds out "
       "how to "
       "read them, and writes a site file in which each guess stands as a comment beside its key. "
       "Files of the same meters that follow each other in time are put together. Nothing is "
       "written where a file cannot be understood, and no site file is written over. With --epw "
       "and --use the site gets weather and a starter model of a typical building.",
       {{"recald init export.csv --timezone Europe/Berlin", "Write site.toml here"},
        {"recald init 2023.csv 2024.csv --timezone Europe/Berlin --out office",
         "Two years of the same meters, into office/site.toml"},
        {"recald init usage.xml --epw place.epw --use office --area 7800 --storeys 3",
         "With weather and a starter model"}},
       {{"site.toml", "Written, in the folder of --out or here"}}},
      {"check",
       "Reads a site file and everything that it names, and says what is wrong in a sentence each, "
       "with file and line. Where nothing is wrong it lists meters, weather and priors as recald "
       "understands them. With --meters each live meter is read once, with --alerts every "
       "destination gets a trial message.",
       {{"recald check site.toml", "Before the daemon starts"},
        {"recald check site.toml --meters", "After wiring a meter"}},
       {kPageSite, kPageData}},
      {"scan",
       "Asks each Modbus address of a bus whether somebody answers, and prints what devices say of "
       "themselves. A daemon that uses the bus has to be stopped first.",
       {{"recald scan site.toml --bus roof --units 1-32", "Find the meters of a new bus"}},
       {kPageSite}},
      {"decode",
       "Explains a Modbus frame byte by byte, with the values that a register map finds in it: for "
       "a meter whose values look wrong.",
       {{"recald decode --map abb-b23 --hex \"00 01 00 00 00 05 01 03 02 00 2a\"",
         "A reply over TCP"}},
       {{"MAP.toml", "A register map of your own, read if --map names one"}}},
  };
}

PageList gateway_pages() {
  return {
      {"run",
       "Polls the meters of a site, takes what others send, closes months, recalibrates, watches "
       "for drift, sends alerts and serves pages, until SIGTERM or SIGINT stops it. SIGHUP makes "
       "it read its site file again. It tells systemd when it is ready, and is usually started as "
       "recald@SITE.service. With --record it also writes everything that meters, other programs "
       "and brokers say to a new file, which recald replay does again: for a report of a fault. "
       "The file has the description of site, buses and meters, and no secrets. The daemon goes "
       "on without it when the disk is full or --record-max-MB is reached, and says so.",
       {{"recald run site.toml", "In the foreground, to look at its log"},
        {"recald run site.toml --record fault.jsonl", "With a recording"}},
       {kPageSite,
        {"FILE", "The recording, written if --record names one; never written over"},
        {"site.db", "The store, read and written; site.db.lock is held while it runs"},
        {"backups/", "A copy of the store each day, written"},
        {"site.models/", "Versions of the model, read and written"}}},
      {"status",
       "Asks a running daemon over HTTP what it is doing: meters, months, jobs, alarms. Its "
       "address comes from the site file or from --url.",
       {{"recald status site.toml", "On the gateway"},
        {"recald status --url http://10.0.0.7:8080 --token-file token", "From another machine"}},
       {kPageSite}},
      {"doctor",
       "Says what a report of a bug needs: version, commit, libraries, machine, user. With a site "
       "file it also opens everything that the file names, and says what is wrong with store, "
       "backups, serial ports, certificates and secrets. It prints no secret and writes nothing. "
       "Run it as the daemon's user.",
       {{"recald doctor", "The machine alone"},
        {"recald doctor site.toml --json", "Everything of a site, for a bug report"}},
       {kPageSite, {"site.db", "The store, read"}}},
      {"registers",
       "Lists the Modbus registers that the daemon serves at a site, with addresses and units; "
       "without a site it prints the page that explains the map.",
       {{"recald registers site.toml", "For whoever programs the building controls"},
        {"recald registers site.toml --csv", "The same for a spreadsheet"}},
       {kPageSite}},
      {"restore",
       "Puts a backup of the store into its place, after checking it and saying what would be "
       "lost. The store that was there is kept under another name. The daemon has to be stopped.",
       {{"recald restore site.toml --list", "Which backups there are"},
        {"recald restore site.toml --dry-run", "What the newest one would lose"},
        {"recald restore site.toml", "Do it"}},
       {kPageSite, {"backups/", "Read"}, {"site.db", "Replaced; the old store is kept beside it"}}},
  };
}

PageList reading_pages() {
  return {
      {"replay",
       "Reads the recorded readings of a site from beginning to end, as the daemon would have, and "
       "prints each month as it closes: daily energy, peak, measured share, and why a month is "
       "unusable. With --out it writes the months as CSV and the page of the meters. "
       "A recording of recald run --record is told from a site file by its content: the same "
       "gateway runs on it, without buses and on its clock, and gives the same intervals, which "
       "are printed as recald export does, or written into --out with months and events. Where "
       "this recald comes to other intervals than the one that recorded, it says which and fails.",
       {{"recald replay site.toml", "All months"},
        {"recald replay site.toml --from 2024-01-01 --to 2024-12-31 --out results",
         "A year, into a folder"},
        {"recald replay fault.jsonl --out again", "A recording"}},
       {kPageSite,
        kPageData,
        kPageStore,
        {"months.csv, meters.html", "Written into --out"},
        {"readings.csv, months.csv, events.jsonl", "Of a recording, written into --out"}}},
      {"profile",
       "Reads the schedules of lights and plugs off the electricity meter: its mean by kind of day "
       "and hour, and how certain that is.",
       {{"recald profile site.toml --out results", "Write profile.json"}},
       {kPageSite, kPageData, kPageStore, {"profile.json", "Written into --out"}}},
      {"verify",
       "Checks the store for damage: the structure of the database, then each row against what "
       "it is derived from. It changes nothing and may run beside the daemon.",
       {{"recald verify site.toml", "After a power cut"}},
       {kPageSite, {"site.db", "The store, read"}}},
      {"export",
       "Writes readings or closed months of the store as CSV, which recald import and init take.",
       {{"recald export site.toml --from 2024-01-01 --out 2024.csv", "Readings of a year"},
        {"recald export site.toml --months", "Months, to standard output"}},
       {kPageSite, {"site.db", "The store, read"}}},
      {"import",
       "Puts readings from a CSV file into the store, for instance those that a logger kept while "
       "the gateway was away. Who, when and why is kept with them. Good readings are not replaced "
       "unless --supersede says so. The daemon has to be stopped.",
       {{"recald import site.toml logger.csv --reason \"gateway was off\" --dry-run",
         "What would happen"},
        {"recald import site.toml logger.csv --reason \"gateway was off\"", "Do it"}},
       {kPageSite, {"site.db", "The store, read and written"}}},
  };
}

PageList calibration_pages() {
  const CommandFile outputs{"calibration.json, draws_*.csv, months.csv, profile.json, report.html",
                            "Written into --out; points.json with --predictive"};
  return {
      {"calibrate",
       "Calibrates the site's model to its closed months: priors of the parameters in, posteriors "
       "out, with the model's own errors among the unknowns. recald picks a sampler, checks "
       "convergence, and doubles the number of draws until the checks pass. Results that fail "
       "them are kept apart and never replace results that passed. A site without a model gets "
       "forecasts of its meters from the outdoor temperature. With --doe a design of simulation "
       "runs takes the place of a site.",
       {{"recald calibrate site.toml --out results", "The usual calibration"},
        {"recald calibrate site.toml --model hourly --out results --seed 7",
         "Another model, other random numbers"},
        {"recald calibrate --doe design --out results", "On runs of a simulation program"}},
       {kPageSite,
        kPageData,
        kPageStore,
        outputs,
        {"priors.csv, doe_inputs.csv, doe_outputs.csv", "The design of --doe, read"}}},
      {"report",
       "Writes one HTML page that needs nothing else. Of a site with a model it shows a "
       "calibration; of a site without one, its meters: use, peaks, profiles, changes. Exports of "
       "meters can be named in the place of a site file: they are looked at as recald init looks "
       "at them, the guesses are printed, and no site file is written. Stamps without an offset "
       "need --timezone; on a terminal recald asks for it.",
       {{"recald report export.csv --timezone Europe/Berlin", "A first page from an export"},
        {"recald report 2023.xlsx 2024.xlsx --timezone America/Chicago --out page.html",
         "Two files of the same meters"},
        {"recald report site.toml --out page.html", "The page of a site"}},
       {kPageSite, kPageData, kPageStore, {"report.html", "Written, or what --out names"}}},
      {"drift",
       "Forecasts each month from the months before it, with the calibrated model, and says where "
       "and since when the building has left the forecast.",
       {{"recald drift site.toml --out results", "Months since the first twelve"}},
       {kPageSite, kPageData, kPageStore, {"drift.json, drift.html", "Written into --out"}}},
      {"ecm",
       "Says what measures would save, by the calibrated model and with its uncertainty, or what "
       "was saved since a date, by regression and by model.",
       {{"recald ecm site.toml --measure measures.toml --out results", "Before the measures"},
        {"recald ecm site.toml --since 2024-05-01 --out results", "After them"}},
       {kPageSite,
        kPageData,
        kPageStore,
        {"measures.toml", "What measures change and cost, read"},
        {"ecm.json, savings.csv, savings.html", "Written into --out"}}},
  };
}

PageList design_pages() {
  const CommandFile design{"priors.csv, doe_inputs.csv, doe_outputs.csv", "The design, read"};
  return {
      {"doe",
       "Runs the site's model over a design of its parameters and writes inputs and outputs. A "
       "design that was interrupted is continued. An EnergyPlus model runs in processes of its "
       "own.",
       {{"recald doe site.toml --runs 400 --out design", "A new design"},
        {"recald doe site.toml --priors --out check", "Draws from the priors, to check against"}},
       {kPageSite,
        kPageData,
        {"priors.csv, doe_inputs.csv, doe_outputs.csv", "The design, read and written"}}},
      {"screen",
       "Finds which parameters of a design matter, by a lasso regression of its outputs.",
       {{"recald screen --doe design --out results", "Rank the parameters"}},
       {design, {"screen.json", "Written into --out"}}},
      {"metamodel",
       "Fits a meta-model to the runs of a design, which then stands for the simulation. With "
       "--check it predicts the runs of another design and says how well.",
       {{"recald metamodel --doe design --out results", "Fit it"},
        {"recald metamodel --doe design --check corners", "See how good it is"}},
       {design, {"metamodel.json", "Written into --out"}}},
      {"engine",
       "Looks into the EnergyPlus model of a site.",
       {{"recald engine show site.toml", "What it reports"}},
       {kPageSite}},
      {"engine show",
       "Lists the meters that the EnergyPlus model reports and the fields that could be varied, as "
       "lines to paste into the site file.",
       {{"recald engine show site.toml", "Before [[model]] is written"}},
       {kPageSite, {"*.idf, *.epJSON", "The model that the site file names, read"}}},
  };
}

PageList diagnosis_pages() {
  return {
      {"diagnose",
       "Finds where model and meters disagree and which physical effect is missing from the model, "
       "or says that it cannot tell. A name has to hold in months that were set aside. With "
       "--apply the model gets the effect, as a new version. recald effects explains the effects.",
       {{"recald diagnose site.toml --out results", "Look for what is missing"},
        {"recald diagnose site.toml --apply", "And put it into the model"},
        {"recald diagnose site.toml --assume scale_fault:steam",
         "Take an effect as known, at one meter"}},
       {kPageSite,
        kPageData,
        kPageStore,
        kPageModels,
        {"diagnosis.json, diagnosis.html", "Written into --out"}}},
      {"effects",
       "Lists the effects that diagnose knows, by where in the building they are. Of one effect it "
       "says what it does to the meters, what to check in the building, and which measurement "
       "tells it from effects like it.",
       {{"recald effects", "All of them"}, {"recald effects weekend_operation", "One of them"}},
       {}},
      {"detectability",
       "Estimates how visible an effect of a given footprint would be among the readings of a "
       "site, whose data must be without it.",
       {{"recald detectability site.toml --footprint footprint.csv --out results",
         "Of an effect with this footprint"}},
       {kPageSite, kPageData, {"detectability.json", "Written into --out"}}},
      {"model",
       "Each effect that is put into a site's model makes a new version of it. These commands list "
       "the versions and change to one.",
       {{"recald model list site.toml", "All versions"}},
       {kPageSite, kPageModels}},
      {"model list",
       "Lists all versions of the site's model and marks the one in use.",
       {{"recald model list site.toml", "Which version is in force"}},
       {kPageSite, kPageModels}},
      {"model show",
       "Shows one version in full: its effects, what they were accepted on, what they change.",
       {{"recald model show site.toml", "The one in use"}},
       {kPageSite, kPageModels}},
      {"model apply",
       "Puts a version in force that a diagnosis has proposed. A running daemon takes it at its "
       "next calibration.",
       {{"recald model apply site.toml 3fa9", "By the first digits of its name"}},
       {kPageSite, {"site.models/", "Read and written"}}},
      {"model revert",
       "Goes back to the version before the one in use, or to the one that is named.",
       {{"recald model revert site.toml", "To the one before"}},
       {kPageSite, {"site.models/", "Read and written"}}},
  };
}

PageList fleet_pages() {
  return {
      {"worker",
       "Takes the readings of many gateways from a broker into a record in PostgreSQL and "
       "calibrates their sites, each job in a process of its own, until SIGTERM stops it.",
       {{"recald worker fleet.toml", "As a service"},
        {"recald worker fleet.toml --jobs 4 --until-idle", "Work off what is there, then end"}},
       {kPageFleet, {"site.toml and *.epw", "Of each job, in a folder that is removed after it"}}},
      {"fleet",
       "The record of many sites, in PostgreSQL.",
       {{"recald fleet status fleet.toml", "Sites, jobs, troubles"}},
       {kPageFleet}},
      {"fleet init",
       "Makes the tables of the record, or brings those of an older recald up to date.",
       {{"recald fleet init fleet.toml", "Before the first worker starts"}},
       {kPageFleet}},
      {"fleet add",
       "Registers sites, or new versions of their files. A site that cannot be registered is "
       "said and left out.",
       {{"recald fleet add fleet.toml tower.toml annex.toml --use office", "Two sites"}},
       {kPageFleet, kPageSite}},
      {"fleet remove",
       "Takes no more readings from these sites; what is recorded stays.",
       {{"recald fleet remove fleet.toml tower", "By its id"}},
       {kPageFleet}},
      {"fleet status",
       "Lists sites, jobs, and what a person should look at.",
       {{"recald fleet status fleet.toml --json", "For a script"}},
       {kPageFleet}},
      {"fleet serve",
       "Serves the pages and the API of all sites over HTTP until it is stopped.",
       {{"recald fleet serve fleet.toml", "At the address of [http]"}},
       {kPageFleet}},
      {"fleet priors",
       "Prints what the calibrations of other sites of the same use teach one of them, as lines of "
       "its site file.",
       {{"recald fleet priors fleet.toml tower", "For the site 'tower'"}},
       {kPageFleet}},
      {"fleet rerun",
       "Lists jobs that would run again; with --yes it lets them.",
       {{"recald fleet rerun fleet.toml --failed", "Which ones"},
        {"recald fleet rerun fleet.toml tower --month 2024-05 --yes", "One month of one site"}},
       {kPageFleet}},
  };
}

PageList help_pages() {
  return {
      {"man",
       "Prints the manual page of a command, or of recald itself, for man or groff.",
       {{"recald man calibrate | man -l -", "Read it"},
        {"recald man model list | man -l -", "Of a command below another"}},
       {}},
      {"schema",
       "Prints a JSON schema of the site file, with which editors complete keys and mark mistakes.",
       {{"recald schema > recald.schema.json", "For an editor with TOML support"}},
       {}},
      {"completion",
       "Prints a script that makes a shell complete commands, options, values and files.",
       {{"recald completion bash > ~/.local/share/bash-completion/completions/recald",
         "For bash, from the next shell on"}},
       {}},
  };
}

PageList all_pages() {
  PageList all;
  for (const auto& pages : {setup_pages(), gateway_pages(), reading_pages(), calibration_pages(),
                            design_pages(), diagnosis_pages(), fleet_pages(), help_pages()}) {
    all.insert(all.end(), pages.begin(), pages.end());
  }
  return all;
}

}  // namespace

std::span<const CommandPage> command_pages() {
  static const PageList all = all_pages();
  return all;
}

const CommandPage* find_command_page(std::string_view command) {
  const auto pages = command_pages();
  const auto found = std::ranges::find(pages, command, &CommandPage::command);
  return found == pages.end() ? nullptr : &*found;
}

}  // namespace recald::daemon
