//! The command line: arguments become a command, its result an exit code.

use clap::{Args, Parser, Subcommand};
use coralpipe::study::screen::{show, show_copy};
use coralpipe::study::{self, run::Request};
use coralpipe::{Error, Result};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Buried pipes and layered ground under a blast wave.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Mesh and solve a case, and write its results
    Run {
        #[command(flatten)]
        case: CaseArguments,
        /// Results folder [default: output/NAME]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Glue pipes and ground together: no opening, no slip
        #[arg(long)]
        bonded: bool,
        /// Compute nothing where the folder has the results of this very case and mesh by this program
        #[arg(long)]
        unless_done: bool,
        /// Let a run begin whatever its size: steps, frames, time, bytes against the free disk
        #[arg(long)]
        large: bool,
        /// Print the results only, not what is going on
        #[arg(long)]
        quiet: bool,
    },
    /// Make the mesh of a case with gmsh, unless it is there already
    Mesh {
        #[command(flatten)]
        case: CaseArguments,
    },
    /// Find everything that can be wrong with a case or a mesh, without solving
    Check {
        #[command(flatten)]
        case: CaseArguments,
    },
    /// Natural frequencies, and mode shapes as .vtu
    Modes {
        #[command(flatten)]
        case: CaseArguments,
        /// How many modes
        #[arg(short = 'n', default_value_t = 6)]
        count: usize,
        /// Results folder [default: output/NAME]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Load parameters of an explosion, its pulse and the curve
    Blast(BlastArguments),
    /// Make many runs from one plan: what shares its matrices marches together, what is done is not done again
    Sweep {
        /// {"case": "twin_pipes.json", "set": {"PATH": [VALUES]}, "geo": {"NAME": [NUMBERS]}}; every combination is run
        #[arg(value_name = "SWEEP.json")]
        plan: PathBuf,
        /// Results folder [default: output/NAME]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Let the runs begin whatever their size: steps, frames, time, bytes against the free disk
        #[arg(long)]
        large: bool,
        /// Print the table only, not what is going on
        #[arg(long)]
        quiet: bool,
    },
    /// How large the ground must be: grow it, compute again, until nothing asked for changes
    Domain {
        #[command(flatten)]
        case: CaseArguments,
        #[command(flatten)]
        options: DomainArguments,
    },
    /// What error mesh and time step leave in each peak: both refined, extrapolated after Richardson
    Converge {
        #[command(flatten)]
        case: CaseArguments,
        /// What is asked for: A.uy, A.v, pipe_left.M [default: displacement and acceleration of all probes]
        #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
        compare: Vec<String>,
        /// The script's constant that all element sizes are divided by
        #[arg(long, value_name = "NAME", default_value = "refine")]
        refine: String,
        /// A mesh's fineness over that of the one before
        #[arg(long, value_name = "FACTOR", default_value_t = 1.5)]
        ratio: f64,
        /// Results folder, DIR/converge [default: output/NAME]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Let the runs begin whatever their size: steps, frames, time, bytes against the free disk
        #[arg(long)]
        large: bool,
        /// Print the results only, not what is going on
        #[arg(long)]
        quiet: bool,
    },
    /// Print the JSON Schema of the case file, for editors
    Schema {
        /// That of the plan of a sweep
        #[arg(long)]
        sweep: bool,
    },
}

#[derive(Debug, Args)]
pub struct BlastArguments {
    /// Mass of the charge, as "500 kg"
    #[arg(long, allow_hyphen_values = true)]
    charge: String,
    /// Distance along the ground, as "20 m"
    #[arg(long, allow_hyphen_values = true)]
    standoff: Option<String>,
    /// Height of the burst above the ground, as "10 m"
    #[arg(long, allow_hyphen_values = true)]
    height: Option<String>,
    /// tnt, anfo, composition_b, c4, h6, minol, octol, petn, pentolite, tetryl, tritonal [default: tnt]
    #[arg(long)]
    explosive: Option<String>,
    /// Mass of TNT that a unit mass of the explosive equals [default: the explosive's]
    #[arg(long, allow_hyphen_values = true)]
    equivalence: Option<String>,
    /// kingery_bulmash, swisdak, kinney_graham, sadovsky, sadovsky_manuals, brode, henrych, mills, newmark_hansen
    /// [default: kingery_bulmash]
    #[arg(long)]
    formula: Option<String>,
    /// hemispherical, spherical [default: spherical with a height, else hemispherical]
    #[arg(long)]
    burst: Option<String>,
    /// Pressure of the pulse that is drawn: incident, reflected
    #[arg(long, default_value = "incident")]
    wave: String,
    /// Its form: friedlander, tangent, equal_impulse
    #[arg(long, default_value = "friedlander")]
    form: String,
    /// Write the curve, its points where it bends: FILE.csv, which the law "table" reads, or FILE.svg
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Print JSON, in SI
    #[arg(long)]
    json: bool,
}

impl BlastArguments {
    fn request(self) -> study::blast::Request {
        let keys = [
            ("charge", Some(self.charge)),
            ("standoff", self.standoff),
            ("height", self.height),
            ("explosive", self.explosive),
            ("equivalence", self.equivalence),
            ("formula", self.formula),
            ("burst", self.burst),
            ("wave", Some(self.wave)),
            ("form", Some(self.form)),
        ];
        let keys = keys.into_iter().filter_map(|(key, text)| Some((key, text?))).collect();
        study::blast::Request { keys, out: self.out, json: self.json }
    }
}

#[derive(Debug, Args)]
pub struct CaseArguments {
    /// The case, a .json file
    #[arg(value_name = "CASE.json", default_value = "geo/twin_pipes.json")]
    case: PathBuf,
    /// Give a constant of the .geo script another value; once for each: --geo a=1 --geo b=2
    #[arg(long = "geo", value_name = "NAME=VALUE")]
    geo: Vec<String>,
    /// Give a key of the case another value, once for each key: --set time.step="0.2 ms" --set loads.0.top.pressure.peak=1e5;
    /// a number counts entries of a list from 0, null takes a key out
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// Use this mesh, whatever the case says
    #[arg(long, value_name = "FILE.msh")]
    mesh: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct DomainArguments {
    /// What is compared: probe displacements A, components A.uy, A.vx, A.a, section forces pipe_left.M [default: all probes]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    compare: Vec<String>,
    /// Largest change that counts as none; the paper's by default
    #[arg(long, value_name = "SHARE", default_value = "1.74%")]
    tolerance: String,
    /// End of the window compared, as "39 ms" [default: the case's end]
    #[arg(long, value_name = "TIME")]
    until: Option<String>,
    /// A size over the one before
    #[arg(long, value_name = "FACTOR", default_value_t = 1.5)]
    growth: f64,
    /// How often each of width, height and both may grow
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    sizes: usize,
    /// The script's constant for the width
    #[arg(long, value_name = "NAME", default_value = "width")]
    width: String,
    /// The script's constant for the height
    #[arg(long, value_name = "NAME", default_value = "height")]
    height: String,
    /// Find alpha and beta anew from each size's own modes
    #[arg(long)]
    own_damping: bool,
    /// Results folder, DIR/domain [default: output/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Let the runs begin whatever their size: steps, frames, time, bytes against the free disk
    #[arg(long)]
    large: bool,
    /// Print the results only, not what is going on
    #[arg(long)]
    quiet: bool,
}

impl DomainArguments {
    fn options(self) -> study::domain::Options {
        study::domain::Options {
            compare: self.compare,
            tolerance: self.tolerance,
            until: self.until,
            growth: self.growth,
            sizes: self.sizes,
            width: self.width,
            height: self.height,
            own_damping: self.own_damping,
        }
    }
}

impl CaseArguments {
    fn request(self) -> Result<Request> {
        Ok(Request {
            geo: constants(&self.geo)?,
            case: self.case,
            sets: self.sets,
            mesh: self.mesh,
            out: None,
            bonded: false,
            quiet: false,
            large: false,
        })
    }
}

/// `NAME=VALUE` each, VALUE a number.
fn constants(texts: &[String]) -> Result<BTreeMap<String, f64>> {
    let constant = |text: &String| {
        let (name, value) = text.split_once('=')?;
        value.trim().parse().ok().filter(|v: &f64| v.is_finite()).map(|v| (name.trim().to_string(), v))
    };
    let mut constants = BTreeMap::new();
    for text in texts {
        let (name, value) = constant(text)
            .ok_or_else(|| Error::input(format!("--geo {text}: write NAME=NUMBER, as in --geo spacing=3")))?;
        if constants.insert(name.clone(), value).is_some() {
            return Err(Error::input(format!("--geo gives {name} twice; one of the two would be lost: leave it out")));
        }
    }
    Ok(constants)
}

/// Does what was asked and prints the result: an error where stdout does not take a result that stands nowhere else.
pub fn execute(command: Command) -> Result<()> {
    let is_on_disk = !matches!(command, Command::Check { .. } | Command::Blast(_) | Command::Schema { .. });
    let text = result_of(command)?;
    if is_on_disk {
        show_copy(&text);
        return Ok(());
    }
    show(&text)
}

fn result_of(command: Command) -> Result<String> {
    match command {
        Command::Run { case, out, bonded, unless_done, large, quiet } => {
            let request = Request { out, bonded, large, quiet, ..case.request()? };
            if unless_done { study::run::unless_done(&request) } else { study::run::command(&request) }
        }
        Command::Mesh { case } => study::mesh::command(&case.request()?),
        Command::Check { case } => study::check::command(&case.request()?),
        Command::Modes { case, count, out } => study::modes::command(&Request { out, ..case.request()? }, count),
        Command::Blast(arguments) => study::blast::command(&arguments.request()),
        Command::Sweep { plan, out, large, quiet } => {
            study::sweep::command(&study::sweep::SweepRequest { plan, out, large, quiet })
        }
        Command::Domain { case, mut options } => {
            let (out, large, quiet) = (options.out.take(), options.large, options.quiet);
            study::domain::command(&Request { out, large, quiet, ..case.request()? }, &options.options())
        }
        Command::Converge { case, compare, refine, ratio, out, large, quiet } => {
            let options = study::converge::Options { compare, refine, ratio };
            study::converge::command(&Request { out, large, quiet, ..case.request()? }, &options)
        }
        Command::Schema { sweep } => Ok(study::schema(sweep)),
    }
}
