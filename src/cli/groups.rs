//! Groups of the commands: the help of the program has a heading for each, which clap does not give commands.

use std::fmt::Write;

use clap::Command;
use clap::builder::StyledStr;

/// Headings, and the commands under each; a program without the feature `cluster` lacks some.
const GROUPS: [(&str, &[&str]); 4] = [
    (
        "Working with a service (--server, or RUBMAP_SERVER and RUBMAP_TOKEN)",
        &[
            "upload", "plan", "sweep", "submit", "watch", "ls", "show", "get", "report", "open", "pause",
            "continue", "cancel", "rm",
        ],
    ),
    (
        "Without a service",
        &[
            "demo", "study", "case", "fields", "modes", "repeat", "validate", "fit", "generate", "import",
            "init",
        ],
    ),
    ("Running a service", &["serve", "worker", "migrate", "copy", "token", "backup", "check"]),
    ("This program", &["completions", "man", "help"]),
];

/// Puts the commands of the program under headings.
pub(super) fn grouped(mut program: Command) -> Command {
    program.build();
    let mut list = String::new();
    let styles = program.get_styles().clone();
    let (head, literal) = (styles.get_header(), styles.get_literal());
    let width = program.get_subcommands().map(|command| command.get_name().len()).max().unwrap_or_default();
    for (heading, names) in GROUPS {
        // Writing to a string cannot fail.
        let _ = writeln!(list, "{head}{heading}:{head:#}");
        for command in names.iter().filter_map(|name| program.find_subcommand(name)) {
            let about = command.get_about().map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(list, "  {literal}{:width$}{literal:#}  {about}", command.get_name());
        }
        list.push('\n');
    }
    program
        .help_template(format!(
            "{{about}}\n\n{{usage-heading}} {{usage}}\n\n{{before-help}}{head}Options:{head:#}\n{{options}}"
        ))
        .before_help(StyledStr::from(list.trim_end().to_owned()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::CommandFactory;

    use super::*;

    /// Commands that only a program with the feature `cluster` has.
    const OF_A_CLUSTER: [&str; 3] = ["worker", "migrate", "copy"];

    #[test]
    fn every_command_has_its_place_and_no_other() {
        let mut program = crate::cli::Cli::command();
        program.build();
        let names: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        let known = program.get_subcommands().map(Command::get_name);
        let known: BTreeSet<&str> = known.chain(OF_A_CLUSTER).collect();
        assert_eq!(names.iter().copied().collect::<BTreeSet<_>>(), known);
        assert_eq!(names.len(), known.len());
    }
}
